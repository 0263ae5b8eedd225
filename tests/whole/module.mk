check_PROGRAMS += tests/whole/same_hash
tests_whole_same_hash_SOURCES = tests/whole/same_hash.c
tests_whole_same_hash_LDADD = libduite_cloth.la libduite_core.la
dist_check_SCRIPTS += tests/whole/test_same_hash.sh tests/whole/test_same_hash_long.sh tests/whole/test_dress.sh \
	tests/whole/test_demo.sh
TESTS += tests/whole/test_same_hash.sh tests/whole/test_dress.sh
LONG_TESTS += tests/whole/test_same_hash_long.sh tests/whole/test_demo.sh
dist_check_SCRIPTS += tests/whole/test_physics.sh
TESTS += tests/whole/test_physics.sh
dist_check_SCRIPTS += tests/whole/test_memory.sh
TESTS += tests/whole/test_memory.sh
dist_check_SCRIPTS += tests/whole/test_input.sh tests/whole/test_options.sh
TESTS += tests/whole/test_input.sh tests/whole/test_options.sh
dist_check_SCRIPTS += tests/whole/test_policies.sh
TESTS += tests/whole/test_policies.sh
dist_check_SCRIPTS += tests/whole/test_system.sh
TESTS += tests/whole/test_system.sh
