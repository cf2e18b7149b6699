# JavaScript of the page and of the player: lint and types (npm), unit tests (node 18.18 or newer; Debian: nodejs npm).
# Without node they are left out, and make says so.
.PHONY: lint-javascript format-javascript test-javascript clean-javascript count-javascript
lint: lint-javascript
test: test-javascript
CHECKS += lint-javascript test-javascript
clean: clean-javascript

JAVASCRIPT := .javascript
JS_CACHE := $(JAVASCRIPT)/node_modules/.cache
IN_NODE := $(JAVASCRIPT)/node_modules/.bin
PRETTIER := $(IN_NODE)/prettier --config $(JAVASCRIPT)/package.json --log-level warn \
  $(JAVASCRIPT)/*.js 'service/**/*.js' 'tests/**/*.mjs'

ifneq ($(shell sh -c 'command -v npm'),)
lint-javascript: $(JAVASCRIPT)/node_modules/.installed $(JAVASCRIPT)/openapi.d.ts
	$(PRETTIER) --check
	$(IN_NODE)/eslint --config $(JAVASCRIPT)/eslint.config.js --max-warnings 0 --cache --cache-location $(JS_CACHE)/eslint \
	  $(JAVASCRIPT) service tests
	$(IN_NODE)/tsc --project service/page --incremental --tsBuildInfoFile $(JS_CACHE)/types

format-javascript: $(JAVASCRIPT)/node_modules/.installed
	$(PRETTIER) --write

# Statements by folder, compared with BASE.
count-javascript: $(JAVASCRIPT)/node_modules/.installed
	@node $(JAVASCRIPT)/statements.js $(BASE)

# The shapes of the API, from its own description: anew whenever Python has changed.
$(JAVASCRIPT)/openapi.d.ts: $(JAVASCRIPT)/node_modules/.installed $(VENV)/.installed-test $(JAVASCRIPT)/describe.py \
  $(shell find model objectives optimise service -name '*.py')
	$(BIN)/python $(JAVASCRIPT)/describe.py >$(JAVASCRIPT)/openapi.json
	$(IN_NODE)/openapi-typescript $(JAVASCRIPT)/openapi.json --output $@ >/dev/null
else
lint-javascript:
	@echo 'SKIPPED: lint and types of the JavaScript, which need npm; on Debian: apt install nodejs npm' >&2
endif

test-javascript:
ifneq ($(shell sh -c 'command -v node'),)
	node --test --test-reporter spec $(shell find tests -name '*.test.mjs')
else
	@echo 'SKIPPED: unit tests of the JavaScript, which need node; on Debian: apt install nodejs' >&2
endif

clean-javascript:
	rm -rf $(JAVASCRIPT)/node_modules $(JAVASCRIPT)/openapi.*

$(JAVASCRIPT)/node_modules/.installed: $(JAVASCRIPT)/package.json $(JAVASCRIPT)/package-lock.json
	@echo 'Installing into $(JAVASCRIPT)/node_modules ...'
	@cd $(JAVASCRIPT) && npm ci --no-audit --no-fund --loglevel=error
	@touch $@
