"""Event-driven simulation: equations of motion, slip, stick, and the transitions between them."""
