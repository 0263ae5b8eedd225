if HAVE_CHECK
ASAN_TESTS += tests/cloth/verify/test_enter tests/cloth/verify/test_meet tests/cloth/verify/test_sweep
tests_cloth_verify_test_enter_SOURCES = tests/cloth/verify/test_enter.c tests/cloth/contact/bodies.h
tests_cloth_verify_test_enter_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_verify_test_meet_SOURCES = tests/cloth/verify/test_meet.c
tests_cloth_verify_test_meet_LDADD = $(CLOTH_TEST_LIBS)
tests_cloth_verify_test_sweep_SOURCES = tests/cloth/verify/test_sweep.c
tests_cloth_verify_test_sweep_LDADD = $(CLOTH_TEST_LIBS)
endif
if HAVE_CHECK
if HAVE_GMP
ASAN_TESTS += tests/cloth/verify/test_exact
tests_cloth_verify_test_exact_SOURCES = tests/cloth/verify/test_exact.c
tests_cloth_verify_test_exact_LDADD = $(CLOTH_TEST_LIBS) $(GMP_LIBS)
endif
endif
