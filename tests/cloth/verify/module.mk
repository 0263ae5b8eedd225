if HAVE_CHECK
ASAN_TESTS += tests/cloth/verify/test_enter tests/cloth/verify/test_meet tests/cloth/verify/test_sweep
tests_cloth_verify_test_enter_SOURCES = tests/cloth/verify/test_enter.c tests/cloth/contact/bodies.h
endif
if HAVE_CHECK
if HAVE_GMP
ASAN_TESTS += tests/cloth/verify/test_exact
tests_cloth_verify_test_exact_LDADD = $(CLOTH_TEST_LIBS) $(GMP_LIBS)
endif
endif
