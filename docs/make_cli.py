#!/usr/bin/python3
"""Prints docs/reference/cli.md: what the program and each of its commands print for --help. Usage: make_cli.py PLICA"""
import re
import subprocess
import sys


def help_of(*command):
    text = subprocess.run([sys.argv[1], *command, "--help"], capture_output=True, text=True, check=True).stdout.strip()
    return re.sub(r"(--jobs INT:INT in \[.+?\])=\d+", r"\1=CORES", text)  # the default is the machine's


whole = help_of()
commands = re.findall(r"^  ([a-z]\w*) ", whole.partition("\nSubcommands:\n")[2], re.M)
if not commands:
    sys.exit("make_cli.py: the program's help names no commands")
print("# Command line\n\n"
      "For those who look for an option. What `plica --help` and the help of each command print, written by "
      "[make_cli.py](make_cli.py).\n\n"
      f"```text\n{whole}\n```")
for name in commands:
    print(f"\n## plica {name}\n\n```text\n{help_of(name)}\n```")
