"""Links inside a built site: every file and every anchor that pages name must be there, and nothing comes from elsewhere."""
import os
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        link = attributes.get("href") or attributes.get("src")
        if link:
            self.links.append((tag, link))


def broken(folder):
    pages, faults = {}, []
    for where, _, names in os.walk(folder):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(where, name)
                with open(path) as f:
                    pages[path] = Page(f.read())
    for path, page in sorted(pages.items()):
        for tag, link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                if tag != "a":
                    faults.append(f"{os.path.relpath(path, folder)}: comes from elsewhere: {link}")
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), unquote(parts.path))) if parts.path else path
            if not os.path.exists(target):
                faults.append(f"{os.path.relpath(path, folder)}: broken link: {link}")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{os.path.relpath(path, folder)}: no such place: {link}")
    return faults
