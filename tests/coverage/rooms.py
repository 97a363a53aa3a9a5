"""What gcovr counted (its JSON), room by room: `rooms.py lines.json [--gaps]`."""

import json
import sys

ROOMS = ("catalog", "structures", "elements", "pairing", "assembly", "operators")


def ranges(numbers):
    """1, 2, 3, 7 -> "1-3, 7"."""
    found = []
    for number in sorted(numbers):
        if found and found[-1][1] == number - 1:
            found[-1][1] = number
        else:
            found.append([number, number])
    return ", ".join(f"{first}-{last}" if last > first else str(first) for first, last in found)


def main(path, gaps=False):
    with open(path, encoding="utf-8") as file:
        lines = {entry["file"]: {line["line_number"]: line["count"] > 0 for line in entry["lines"] if not line.get("gcovr/noncode")}
                 for entry in json.load(file)["files"]}
    print(f"{'room':<12}{'lines':>8}{'run':>8}{'%':>8}")
    for room in (*ROOMS, "all"):
        run = [is_run for name, of_file in lines.items() if room in ("all", name.partition("/")[0]) for is_run in of_file.values()]
        print(f"{room:<12}{len(run):>8}{sum(run):>8}{100 * sum(run) / max(1, len(run)):>8.1f}")
    if gaps:
        missed = {name: [number for number, is_run in of_file.items() if not is_run] for name, of_file in lines.items()}
        for name in sorted(missed, key=lambda name: (-len(missed[name]), name)):
            if missed[name]:
                print(f"{name}: {len(missed[name])} of {len(lines[name])}: {ranges(missed[name])}")


if __name__ == "__main__":
    main(sys.argv[1], "--gaps" in sys.argv[2:])
