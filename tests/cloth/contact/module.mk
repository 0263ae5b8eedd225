if HAVE_CHECK
check_PROGRAMS += tests/cloth/contact/test_meet
tests_cloth_contact_test_meet_SOURCES = tests/cloth/contact/test_meet.c
tests_cloth_contact_test_meet_LDADD = $(CLOTH_TEST_LIBS)
TESTS += tests/cloth/contact/test_meet
endif
