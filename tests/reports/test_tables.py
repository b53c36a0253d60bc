"""Tables in Markdown."""

from symfpu.reports.tables import markdown_table


def test_markdown_table():
    assert markdown_table(["a", "b"], [["1", "2"]]) == "| a | b |\n| --- | --- |\n| 1 | 2 |"
