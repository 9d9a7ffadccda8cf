"""Summarizes the JUnit files of a test run: test_summary.py FOLDER, for scripts/test and scripts/sanitize.

Prints failed and skipped tests with the reasons, and as last line the numbers of passed and failed tests.
An unreadable file counts as a failure (its program crashed), and so does a directory without tests.
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree

MOST_LINES = 25  # of the output of a test


def outcome(case):
    """Returns "passed", "failed" or "skipped" of a <testcase>, and why."""
    for kind, result in (("failure", "failed"), ("error", "failed"), ("skipped", "skipped")):
        found = case.find(kind)
        if found is not None:
            return result, (found.get("message") or found.text or "").strip()
    return case.get("result") if case.get("result") == "skipped" else "passed", ""


def main(directory):
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    files = sorted(pathlib.Path(directory).rglob("*.xml"))
    for path in files:
        try:
            cases = list(ElementTree.parse(path).getroot().iter("testcase"))
        except ElementTree.ParseError as error:
            counts["failed"] += 1
            print(f"FAILED {path.name}: {error}")
            continue
        for case in cases:
            result, why = outcome(case)
            if result == "passed" and case.get("classname") == "rostest.runner.RosTest":
                continue  # wrapper of a rostest; its cases are in a separate file
            counts[result] += 1
            if result != "passed":
                print(f"{result.upper()} {case.get('classname')}.{case.get('name')}: ", end="")
                print(*why.splitlines()[:MOST_LINES], sep="\n")
                if len(why.splitlines()) > MOST_LINES:
                    print(f"... and more in {path}")
    if not counts["passed"] + counts["failed"]:
        counts["failed"] += 1
        print(f"FAILED no test was run: {directory} has no results")
    print(f"{counts['skipped']} skipped")
    print(counts["passed"], counts["failed"])


if __name__ == "__main__":
    main(sys.argv[1])
