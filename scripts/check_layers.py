#!/usr/bin/env python3
"""Checks that each folder of src/stereovox includes only what the layers allow, and that no source
file exceeds 500 lines. Prints each breach; exit status 1 when there is one.

usage: check_layers.py [ROOT]"""

import pathlib
import re
import sys

MAY_INCLUDE = {
    "core": [],
    "io": ["core"],
    "dataset": ["core", "io"],
    "stereo": ["core"],
    "odometry": ["core"],
    "occupancy": ["core", "io"],
    "navmap": ["core", "io", "occupancy"],
    "baselines": ["core", "io", "navmap"],
    "evaluation": ["core", "io", "occupancy", "navmap"],
    "simulation": ["core", "io", "dataset"],
    "pipeline": ["core", "io", "dataset", "stereo", "odometry", "occupancy", "navmap"],
    "experiment": ["core", "io", "dataset", "stereo", "odometry", "occupancy", "navmap", "baselines",
                   "evaluation", "simulation", "pipeline"],
}
MAX_LINES = 500
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')


def breaches_of(path, stage):
    lines = path.read_text(encoding="utf-8").splitlines()
    if len(lines) > MAX_LINES:
        yield f"{path}: {len(lines)} lines, at most {MAX_LINES} are allowed"
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        parts = match.group(1).split("/")
        if parts[0] != "stereovox" or len(parts) != 3:
            yield f'{path}:{number}: include "{match.group(1)}" is not "stereovox/<stage>/<file>"'
        elif parts[1] != stage and parts[1] not in MAY_INCLUDE[stage]:
            yield f"{path}:{number}: {stage} may not include {parts[1]}"


def all_breaches(root):
    source = root / "src" / "stereovox"
    for folder in sorted(p for p in source.iterdir() if p.is_dir()):
        if folder.name not in MAY_INCLUDE:
            yield f"{folder}: is no stage"
            continue
        for path in sorted(folder.rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield from breaches_of(path, folder.name)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    found = list(all_breaches(root))
    for breach in found:
        print(breach)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
