"""What a report was made with: versions and the kind of machine, but neither its name nor its folders."""

from __future__ import annotations

import os
import platform
from datetime import datetime, timezone

from compare.run.findings_store import LIBRARIES, exudyn_user_settings, version_of


def platform_stamp() -> dict[str, str]:
    """Return versions, operating system, number of cores and date, ready to print."""
    return {
        "friction-discs": version_of("friction-discs"),
        "Python": platform.python_version(),
        **{name: version_of(name) for name in LIBRARIES},
        "user settings of Exudyn": exudyn_user_settings(),
        "system": f"{platform.system()} {platform.machine()}",
        "cores": str(os.cpu_count()),
        "date": datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC"),
    }
