#!/bin/sh
# test_contact.sh by every step length, material and integrator.
DUITE_LONG=1
export DUITE_LONG
. "${srcdir:-.}/tests/whole/test_contact.sh"
