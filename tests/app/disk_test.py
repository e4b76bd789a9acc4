"""Disks that fail in the middle of a run, at any call: it ends with status 4 and says why, and --resume loses nothing.

By hand, every N-th call of a longer run with divisions, for some of the tests:
disk_test.py PROGRAM --long --every 10 FailingDisk.test_full_from_any_write_on
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import support
from resuming import DIVIDING, LOST, Resuming
from support import BLOCK, SPHERE, ended, plica, rows_in, running

SHORT = [("time.end_s", "1.2"), ("division.all.region", '"all"'), ("division.all.at_s", "0.5"), ("division.all.growth_s", "0.3")]
EVERY, LONG = 10, False
SHIM = None  # the library of failing_disk.c, once it is compiled


def shim():
    global SHIM
    if SHIM is None:
        SHIM = Path(tempfile.mkdtemp(prefix="plica_failing_disk_")) / "failing_disk.so"
        source = Path(__file__).with_name("failing_disk.c")
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", SHIM, source, "-ldl"], check=True)
    return SHIM


def tearDownModule():
    if SHIM is not None:
        shutil.rmtree(SHIM.parent, ignore_errors=True)


def is_sanitized():
    program = Path(support.PROGRAM).read_bytes()
    return b"__asan_init" in program or b"__tsan_init" in program


@unittest.skipIf(shutil.which("cc") is None, "needs a C compiler")
class FailingDisk(Resuming):
    def setUp(self):
        super().setUp()
        if is_sanitized():
            self.skipTest("a sanitizer must be loaded before all else")
        self.scenario = DIVIDING if LONG else [self.write(BLOCK), *(word for key, value in SHORT for word in ("--set", f"{key}={value}"))]
        self.whole = self.whole_run(self.scenario)

    def run_on_failing_disk(self, call, number, *more):
        """The run on a disk whose calls of a kind fail from that number on, and how many there were."""
        count = self.folder / "count"
        environment = os.environ | {
            "LD_PRELOAD": str(shim()), "PLICA_FAIL_BELOW": str(self.out), "PLICA_FAIL_CALL": call, "PLICA_FAIL_FROM": str(number),
            "PLICA_FAIL_COUNT": str(count)}
        result = plica("run", *self.scenario, "--out", self.out, "--quiet", *more, env=environment, timeout=300)
        return result, int(count.read_text())

    def fail_at_every(self, call, every, reason):
        result, calls = self.run_on_failing_disk(call, 0)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(calls, 10, f"the disk heard of {calls} calls of {call}")
        self.assert_same(self.out, self.whole)
        cut_back = 0
        cases = range(1, calls + 1, every)
        for number in cases:
            with self.subTest(call=call, number=number):
                shutil.rmtree(self.out)
                result, _ = self.run_on_failing_disk(call, number)
                self.assertEqual(result.returncode, 4, f"{result.stdout}{result.stderr}")
                self.assert_says(result, str(self.out), reason, "--resume")
                self.assert_whole(self.out)  # nor is anything left that is half written
                rows = rows_in(self.out)
                resumed = self.resumed(self.scenario)
                found = re.search(r"resuming after step (\d+)", resumed.stdout)
                if found:
                    self.assertIn(rows - int(found.group(1)), LOST, "more is lost than the steps since the last checkpoint")
                    cut_back = max(cut_back, rows - int(found.group(1)))
                else:
                    self.assertEqual(rows, 0, "began anew though steps had been made")
                self.assert_same(self.out, self.whole)
        print(f"{len(cases)} runs of {rows_in(self.folder / 'whole')} steps on a disk that failed at one of {calls} calls of {call}: "
              f"at most {cut_back} rows cut back, every one went on to the same bits")

    def test_full_from_any_write_on(self):
        self.fail_at_every("write", EVERY, "No space left")

    def test_fsync_fails(self):
        self.fail_at_every("fsync", EVERY, "Input/output error")

    def test_rename_fails(self):
        self.fail_at_every("rename", EVERY, "Input/output error")

    def test_becomes_read_only(self):
        self.fail_at_every("open", EVERY, "Read-only file system")

    def test_fails_again_while_going_on(self):
        self.run_on_failing_disk("write", 40)
        for number in (1, 2, 3, 5, 8, 13):
            with self.subTest(number):
                result, _ = self.run_on_failing_disk("write", number, "--resume")
                self.assertEqual(result.returncode, 4, result.stderr)
                self.assert_whole(self.out)
        self.resumed(self.scenario)
        self.assert_same(self.out, self.whole)


class Directory(Resuming):
    def test_removed(self):
        scenario = [self.write(BLOCK), "--set", "time.end_s=20"]
        whole, moved = self.whole_run(scenario), self.folder / "moved"
        with running("run", self.write(BLOCK), "--set", "time.end_s=1e9", "--out", self.out, "--quiet") as process:
            while process.poll() is None and rows_in(self.out) < 50:
                pass
            self.out.rename(moved)
            result = ended(process)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assert_says(result, str(self.out))
        self.assertFalse(self.out.exists(), "the directory came back")
        moved.rename(self.out)
        self.assertIn("resuming after step", self.resumed(scenario, "--set", "time.end_s=1e3", "--set", "time.step_s=20").stdout)
        shutil.rmtree(self.out)
        self.resumed(scenario)
        self.assert_same(self.out, whole)


class Memory(Resuming):
    def test_out_of_memory_is_a_clear_end_from_which_to_go_on(self):
        if is_sanitized():
            self.skipTest("a sanitizer takes all the address space")
        sphere = [self.write(SPHERE)]
        whole = self.whole_run(sphere)
        ends = {}
        for mebibytes in range(140, 500, 20):
            support.count_case()
            shutil.rmtree(self.out, ignore_errors=True)

            def limited(*words):
                shell = ["bash", "-c", f'ulimit -v {mebibytes * 1024}; exec "$0" "$@"', support.PROGRAM, *words]
                return subprocess.run([str(word) for word in shell], capture_output=True, text=True, timeout=60)

            if limited("--version").returncode != 0:
                continue  # not enough to load the program and what its libraries make before it begins
            result = limited("run", sphere[0], "--quiet", "--threads", "1", "--out", self.out)
            with self.subTest(mebibytes):
                ends[result.returncode] = ends.get(result.returncode, 0) + 1
                self.assertIn(result.returncode, (0, 3), result.stderr)
                if result.returncode != 0:
                    self.assert_says(result, "out of memory")
                self.resumed(sphere)
                self.assert_same(self.out, whole)
        print("statuses under limits of memory: " + ", ".join(f"{count} times {status}" for status, count in sorted(ends.items())))
        self.assertIn(3, ends)


if __name__ == "__main__":
    if "--long" in sys.argv:
        LONG = True
        sys.argv.remove("--long")
    EVERY = int(support.option("--every", EVERY))
    support.main()
