#!/bin/sh
# All commands of the pages of docs/, in their order: long ones go on with what short ones leave.
CLASS=every exec "${SHELL:-/bin/sh}" "${srcdir:-.}/tests/pages.sh"
