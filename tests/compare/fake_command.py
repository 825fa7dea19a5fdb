"""The command line with the fake studies instead of the paper's."""

from __future__ import annotations

import fake_studies

from compare.cli import main
from compare.engines import register

if __name__ == "__main__":
    for engine in (fake_studies.GOOD, fake_studies.ALSO_GOOD, fake_studies.FAILING):
        register(engine)
    main(studies=fake_studies.ALL)
