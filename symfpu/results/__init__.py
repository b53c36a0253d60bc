"""What a result is: declared fields, and from them its record, text, HTML, table and data set."""
