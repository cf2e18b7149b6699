/** Lint of the page's modules, of the player of exported motions, and of their tests. Run from the top of the project. */

import js from "@eslint/js";
import globals from "globals";

export default [
  js.configs.recommended,
  {
    rules: {
      eqeqeq: "error",
      "no-unused-vars": [
        "error",
        { varsIgnorePattern: "^_", argsIgnorePattern: "^_", destructuredArrayIgnorePattern: "^_" },
      ],
      "no-var": "error",
      "object-shorthand": "error",
      "prefer-const": ["error", { destructuring: "all" }],
    },
  },
  { files: ["service/page/static/**/*.js"], languageOptions: { globals: globals.browser } },
  {
    files: ["service/motion/player/*.js"],
    languageOptions: { globals: globals.browser, sourceType: "script" },
  },
  { files: ["tests/**/*.mjs", ".javascript/*.js"], languageOptions: { globals: globals.node } },
];
