#!/bin/sh
# Certificates of 10^6 random pairs of each sort: they and their cuts hold, and what is certain is true in exact arithmetic.
. "${srcdir:-.}/tests/support/tap.sh"
DUITE_LONG=1
export DUITE_LONG
plan_later
ok "closest points" tests/cloth/contact/test_pair
ok "certificates and cuts" tests/cloth/contact/test_certificate
if test -x tests/cloth/contact/test_certificate_exact; then
    ok "what is certain is true" tests/cloth/contact/test_certificate_exact
else
    skip "what is certain is true" "libgmp is missing"
fi
