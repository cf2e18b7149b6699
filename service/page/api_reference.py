"""Page that describes the API and lets readers try its requests: Swagger UI, from an installed package."""

import hashlib
import re
from base64 import b64encode
from functools import cache
from importlib.resources import files

from fastapi import APIRouter, Request, Response
from fastapi.openapi.docs import get_swagger_ui_html

from .router import POLICY, content_tag, response_with_etag

router = APIRouter(include_in_schema=False)
_TYPES = {"swagger-ui-bundle.js": "text/javascript", "swagger-ui.css": "text/css"}


@router.get("/docs")
async def show_reference() -> Response:
    """Return the page; its addresses are relative, so that it works behind a proxy too."""
    page = get_swagger_ui_html(
        openapi_url="openapi.json",
        title="slidercrank: HTTP API",
        swagger_js_url="docs/swagger-ui-bundle.js",
        swagger_css_url="docs/swagger-ui.css",
        swagger_favicon_url="/page/icon.svg",
        swagger_ui_parameters={"docExpansion": "list", "filter": True, "defaultModelsExpandDepth": 0},
    )
    (script,) = re.findall(rb"<script>(.*?)</script>", bytes(page.body), re.DOTALL)
    digest = b64encode(hashlib.sha256(script).digest()).decode()
    page.headers["Content-Security-Policy"] = POLICY.replace(
        "script-src 'self'", f"script-src 'self' 'sha256-{digest}'"
    ).replace("style-src 'self'", "style-src 'self' 'unsafe-inline'")
    return page


@router.get("/docs/swagger-ui-bundle.js")
@router.get("/docs/swagger-ui.css")
def fetch_part(request: Request) -> Response:
    """Return the script or the style of the page."""
    name = request.url.path.rpartition("/")[2]
    content = _part(name)
    return response_with_etag(request, content_tag(content), lambda: Response(content, media_type=_TYPES[name]))


@cache
def _part(name: str) -> bytes:
    return files("fastapi_offline").joinpath("static", name).read_bytes()
