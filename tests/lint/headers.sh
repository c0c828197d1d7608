#!/bin/sh
# Every public header compiles alone, as C11 and as C++17.
cd "$(dirname "$0")/../.." || exit 1
bad=0
for header in include/vsss/*.h; do
  cc -std=c11 -Wall -Wextra -Werror -Iinclude -fsyntax-only -x c "$header" || bad=1
  c++ -std=c++17 -Wall -Wextra -Werror -Wno-pragma-once-outside-header -Iinclude -fsyntax-only -x c++ "$header" || bad=1
done
exit $bad
