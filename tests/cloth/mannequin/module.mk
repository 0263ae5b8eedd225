if HAVE_CHECK
PLAIN_TESTS += tests/cloth/mannequin/test_mannequin tests/cloth/mannequin/test_walk
tests_cloth_mannequin_test_mannequin_SOURCES = tests/cloth/mannequin/test_mannequin.c tests/cloth/mannequin/tools.h
tests_cloth_mannequin_test_mannequin_LDADD = $(CLOTH_TEST_LIBS) -lm
tests_cloth_mannequin_test_walk_SOURCES = tests/cloth/mannequin/test_walk.c tests/cloth/mannequin/tools.h
tests_cloth_mannequin_test_walk_LDADD = $(CLOTH_TEST_LIBS) -lm
endif
