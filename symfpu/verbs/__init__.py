"""The verbs of the command line: each parses, calls one public function, prints or writes."""
