#!/usr/bin/python3
"""Print docs/reference/cli.md: the help of the program and of each command. Usage: make_cli.py PLICA"""
import re
import subprocess
import sys


def help_of(*command):
    text = subprocess.run([sys.argv[1], *command, "--help"], capture_output=True, text=True, check=True).stdout.strip()
    # The default of --jobs is the machine's; CLI11 writes "=2" before 2.4, " [2] " since.
    return re.sub(r"(--jobs INT:INT in \[.+?\])(=| \[)\d+\b", r"\1\2CORES", text)


whole = help_of()
commands = re.findall(r"^  ([a-z]\w*) ", whole.partition("\nSubcommands:\n")[2], re.M)
if not commands:
    sys.exit("make_cli.py: the program's help names no commands")
print("# Command line\n\n"
      "This page lists all commands and options of `plica`: the output of `plica --help` and of the help of each command, "
      "written by [make_cli.py](../make_cli.py).\n\n"
      f"```text\n{whole}\n```")
for name in commands:
    print(f"\n## plica {name}\n\n```text\n{help_of(name)}\n```")
