"""The motion of a sliding and sticking body, written once for interpreted and compiled runs."""
