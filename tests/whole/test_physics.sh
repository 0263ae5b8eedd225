#!/bin/sh
# The cases of motion, failure and stop once more, with the cloth spread over two ranks.
. "${srcdir:-.}/tests/support/tap.sh"
skip_unless tests/cloth/flow/test_integrators
skip_unless tests/cloth/flow/test_motion
skip_unless tests/cloth/flow/test_run
skip_unless tests/cloth/flow/test_failures
skip_unless tests/cloth/flow/test_memory
skip_unless tests/cloth/flow/test_solvers
plan_later

export CK_RUN_CASE
CK_RUN_CASE=motion
ok "closed forms on 2 ranks" ranks 2 tests/cloth/flow/test_motion
CK_RUN_CASE=run
ok "frames and stops on 2 ranks" ranks 2 tests/cloth/flow/test_run
CK_RUN_CASE=failures
ok "failures on 2 ranks" ranks 2 tests/cloth/flow/test_failures
CK_RUN_CASE=memory
ok "out of memory on one of 2 ranks" ranks 2 tests/cloth/flow/test_memory
CK_RUN_CASE=solvers
ok "preconditioners on 2 ranks" ranks 2 tests/cloth/flow/test_solvers
CK_RUN_CASE=integrators
ok "integrators on 2 ranks" ranks 2 tests/cloth/flow/test_integrators
