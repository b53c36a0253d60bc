"""The HTML of results as elements, text and images."""

from html.parser import HTMLParser


class Elements(HTMLParser):
    """Elements that are opened and closed in their order."""

    def __init__(self):
        super().__init__()
        self.open, self.images, self.text = [], [], ""

    def handle_starttag(self, tag, attributes):
        if tag == "img":
            self.images.append(dict(attributes))
        else:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


def read(page):
    elements = Elements()
    elements.feed(page)
    assert elements.open == []
    return elements
