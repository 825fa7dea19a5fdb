"""Sphinx settings of the site; ``build.py`` gathers the pages."""

import re
from pathlib import Path

from reference_model import __version__

project = "friction-discs"
author = "the friction-discs maintainers"
copyright = f"2026, {author}"
release = version = __version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx_copybutton",
]
html_theme = "furo"
html_title = f"friction-discs {release}"
html_theme_options = {"navigation_with_keys": True}

nb_custom_formats = {".py": ["jupytext.reads", {"fmt": "py:percent"}]}
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_output_stderr = "remove"
exclude_patterns = ["conf.py"]

highlight_language = "text"

smartquotes_action = "qe"  # keeps the dashes of options
myst_heading_anchors = 3
myst_fence_as_directive = ["math"]
html_math_renderer = "mathml"
copybutton_exclude = ".linenos, .gp, .go"
myst_links_external_new_tab = False
suppress_warnings = ["myst.header"]  # the headings of the changelog skip a level

autodoc_default_options = {"members": True, "member-order": "bysource", "show-inheritance": False}
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_rtype = False

ADDED = {
    'role="heading">': 'role="heading" aria-level="2">',
    "<pre>": '<pre tabindex="0">',
    '<div class="math-wrapper': '<div tabindex="0" class="math-wrapper',
    '<aside class="sidebar-drawer">': '<aside class="sidebar-drawer" aria-label="Pages">',
    '<aside class="toc-drawer">': '<aside class="toc-drawer" aria-label="Contents of this page">',
}
"""Attributes that the theme omits."""

LITERAL = re.compile(r"(``.*?``)")


def setup(app):
    """Escape bars such as |v| before other extensions read docstrings, write equations, and complete the pages."""
    app.connect("autodoc-process-docstring", escape_bars, priority=100)
    app.connect("build-finished", complete_for_readers)
    app.add_html_math_renderer("mathml", (mathml, None), (mathml, None))


def mathml(translator, node):
    """Write an equation as MathML, which browsers show without a script or a network."""
    import docutils.nodes
    from latex2mathml.converter import convert

    display = "inline" if isinstance(node, docutils.nodes.math) else "block"
    translator.body.append(convert(node.astext(), display=display))
    raise docutils.nodes.SkipNode


def complete_for_readers(app, exception):
    """Add levels of headings, focus on code blocks and names of sidebars for screen readers and keyboards."""
    for page in Path(app.outdir).rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        for before, after in ADDED.items():
            text = text.replace(before, after)
        page.write_text(text, encoding="utf-8")


def escape_bars(app, what, name, thing, options, lines):
    """Escape bars in place, except in literals and in blocks after a line that ends with two colons."""
    margin = None
    for place, line in enumerate(lines):
        indent = len(line) - len(line.lstrip())
        if margin is not None and line and indent <= margin:
            margin = None
        if margin is None:
            parts = LITERAL.split(line)
            lines[place] = "".join(each if each[:2] == "``" else each.replace("|", r"\|") for each in parts)
            if line.endswith("::"):
                margin = indent
