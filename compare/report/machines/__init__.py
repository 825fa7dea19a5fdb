"""Files of a report that programs read: results, arrays, test cases; and what parts two reports."""
