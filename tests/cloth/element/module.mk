if HAVE_CHECK
ASAN_TESTS += tests/cloth/element/test_kinds
tests_cloth_element_test_kinds_SOURCES = tests/cloth/element/test_kinds.c tests/cloth/element/samples.h tests/cloth/physics/elements.c \
	tests/cloth/physics/elements.h
endif
