# An explorer of all orders in which threads can run the runtime's own code: see tests/model/explore.h.
MODEL_EXPLORER = tests/model/explore.c tests/model/explore.h tests/model/machine.c tests/model/machine.h \
    tests/model/operations.c tests/model/search.c tests/model/search.h tests/model/atomics.h
MODEL_RUNTIME = $(MODEL_EXPLORER) tests/model/runtime.h
ASAN_TESTS += tests/model/test_deque tests/model/test_queue tests/model/test_handover tests/model/test_version tests/model/test_gate \
    tests/model/test_await
PLAIN_TESTS += tests/model/test_explorer tests/model/test_sleep tests/model/test_sleep_queues
LONG_SH += tests/model/test_long.sh
tests_model_test_explorer_SOURCES = tests/model/test_explorer.c $(MODEL_EXPLORER)
tests_model_test_explorer_LDADD =
tests_model_test_deque_SOURCES = tests/model/test_deque.c $(MODEL_RUNTIME)
tests_model_test_queue_SOURCES = tests/model/test_queue.c $(MODEL_RUNTIME)
tests_model_test_sleep_SOURCES = tests/model/test_sleep.c tests/model/plain_queue.h tests/model/silent_comm.h $(MODEL_RUNTIME)
tests_model_test_sleep_queues_SOURCES = $(tests_model_test_sleep_SOURCES)
tests_model_test_handover_SOURCES = tests/model/test_handover.c $(MODEL_RUNTIME)
tests_model_test_version_SOURCES = tests/model/test_version.c $(MODEL_RUNTIME)
tests_model_test_gate_SOURCES = tests/model/test_gate.c $(MODEL_RUNTIME)
tests_model_test_await_SOURCES = tests/model/test_await.c $(MODEL_RUNTIME)
tests_model_test_sleep_queues_CPPFLAGS = $(AM_CPPFLAGS) -DREAL_QUEUES
tests_model_test_deque_LDADD = $(CORE_LIBS)
tests_model_test_queue_LDADD = $(CORE_LIBS)
tests_model_test_sleep_LDADD = $(CORE_LIBS)
tests_model_test_sleep_queues_LDADD = $(CORE_LIBS)
tests_model_test_handover_LDADD = $(CORE_LIBS)
tests_model_test_version_LDADD = $(CORE_LIBS)
tests_model_test_gate_LDADD = $(CORE_LIBS)
tests_model_test_await_LDADD = $(CORE_LIBS)

