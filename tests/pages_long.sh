#!/bin/sh
# The long commands of the pages of docs/.
CLASS=long exec "${SHELL:-/bin/sh}" "${srcdir:-.}/tests/pages.sh"
