#!/bin/bash
# Every C++ file is as clang-format 14 (Debian 12's) writes it; skipped (status 77) where there is another version, which
# writes some lines otherwise. Usage: format_test.sh ROOT
set -euo pipefail
cd "$1"
version=$(clang-format --version)
if [[ $version != *"version 14."* ]]; then
  echo "skipped: not clang-format 14 but $version"
  exit 77
fi
mapfile -t files < <(find src tests bench python -name '*.cpp' -o -name '*.hpp' | sort)
echo "clang-format on ${#files[@]} files"
clang-format --dry-run -Werror "${files[@]}" || {
  echo "To mend it: clang-format -i \$(find src tests bench python -name '*.cpp' -o -name '*.hpp')" >&2
  exit 1
}
