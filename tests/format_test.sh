#!/bin/bash
# Every C++ file is as clang-format writes it. Usage: format_test.sh ROOT
set -euo pipefail
cd "$1"
mapfile -t files < <(find src tests bench -name '*.cpp' -o -name '*.hpp' | sort)
echo "clang-format on ${#files[@]} files"
clang-format --dry-run -Werror "${files[@]}" || {
  echo "To mend it: clang-format -i \$(find src tests bench -name '*.cpp' -o -name '*.hpp')" >&2
  exit 1
}
