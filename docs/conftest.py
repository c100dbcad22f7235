"""The hook of the site imports MkDocs, which tests do without."""

collect_ignore = ["examples/pages.py"]
