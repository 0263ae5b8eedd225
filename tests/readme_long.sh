#!/bin/sh
# The long commands of README.md, and all of them from an installed tree.
LONG=1 exec "${SHELL:-/bin/sh}" "${srcdir:-.}/tests/readme.sh"
