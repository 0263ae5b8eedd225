# How tests run: every program and script prints TAP; tests/support/unit.h and tests/support/tap.sh say what they see.
# A test stands in one list, by the builds that run it; programs in _TESTS, scripts in _SH:
#     LEAK_TESTS, LEAK_SH      make check; AddressSanitizer looks for leaks beside MPI, too; ThreadSanitizer watches the programs
#     TSAN_TESTS               make check, which also ThreadSanitizer and AddressSanitizer watch
#     ASAN_TESTS, ASAN_SH      make check, which also AddressSanitizer watches
#     PLAIN_TESTS, PLAIN_SH    make check alone: a shorter test shows sanitizers the same code, or what is tested is built without them
#     LONG_SH                  make check-long alone: hours, benches, and the commands of documents
LEAK_TESTS =
LEAK_SH =
TSAN_TESTS =
ASAN_TESTS =
ASAN_SH =
PLAIN_TESTS =
PLAIN_SH =
LONG_SH =
TSAN_ALL = $(LEAK_TESTS) $(TSAN_TESTS)
ASAN_ALL = $(TSAN_ALL) $(ASAN_TESTS)
TESTS = $(ASAN_ALL) $(LEAK_SH) $(ASAN_SH) $(PLAIN_TESTS) $(PLAIN_SH)
check_PROGRAMS = $(ASAN_ALL) $(PLAIN_TESTS)
# Tests that look for leaks beside MPI; LEAKS= is none, in half of the time.
LEAKS = $(LEAK_TESTS) $(LEAK_SH)
dist_check_SCRIPTS = $(LEAK_SH) $(ASAN_SH) $(PLAIN_SH) $(LONG_SH)
check_LIBRARIES =
check_DATA =
# Memory that runs out.
SCARCE = tests/support/scarce.c tests/support/scarce.h
SCARCE_WRAP = $(AM_LDFLAGS) -Wl,--wrap=malloc,--wrap=calloc,--wrap=realloc,--wrap=aligned_alloc
DUITE_TEST_LIBS = tests/support/libunit.a $(CORE_LIBS) $(CHECK_LIBS)

# Comments, which have the errors against closed forms, are shown as tests go.
LOG_DRIVER = env AM_TAP_AWK='$(AWK)' $(SHELL) $(top_srcdir)/build-aux/tap-driver.sh --comments
LOG_COMPILER = $(SHELL) $(srcdir)/tests/support/run.sh
# An extension, so that LONG_SH have a rule, too.
TEST_EXTENSIONS = .sh
SH_LOG_DRIVER = $(LOG_DRIVER)
SH_LOG_COMPILER = $(LOG_COMPILER)
# intercept_tls_get_addr=0: LeakSanitizer trips now and then over the thread-local memory of loaded libraries that it follows.
AM_TESTS_ENVIRONMENT = \
    CC='$(CC)'; CXX='$(CXX)'; FC='$(FC)'; CFLAGS='$(CFLAGS) $(SANITIZE_FLAGS)'; PKG_CONFIG='$(PKG_CONFIG)'; MAKE='$(MAKE)'; \
    MPIRUN='$(MPIRUN)'; MPI_CFLAGS='$(MPI_CFLAGS)'; MPI_LIBS='$(MPI_LIBS)'; \
    SANITIZER='$(SANITIZE_FLAGS)'; LEAK_TESTS='$(LEAKS)'; export SANITIZER LEAK_TESTS CC CXX FC CFLAGS PKG_CONFIG MAKE MPIRUN MPI_CFLAGS MPI_LIBS; \
    DUITE_QUICK=$${DUITE_QUICK-$(DUITE_QUICK)}; export DUITE_QUICK; \
    support=`cd '$(srcdir)/tests/support' && pwd`; \
    ASAN_OPTIONS=fast_unwind_on_malloc=0:intercept_tls_get_addr=0:$$ASAN_OPTIONS; export ASAN_OPTIONS; \
    LSAN_OPTIONS=suppressions=$$support/lsan.supp:print_suppressions=0; export LSAN_OPTIONS; \
    TSAN_OPTIONS=suppressions=$$support/tsan.supp; export TSAN_OPTIONS;

# In place of automake's rule of this name: one plain line with the sums of all cases at the end, also after a failure. TEST_JOBS
# tests run at once, whatever make's own -j: most have several ranks or threads, and wait for them.
TEST_JOBS = 2
check-TESTS: $(check_PROGRAMS)
	@$(am__set_TESTS_bases); \
	  logs=`for base in $$bases; do echo $$base.log; done`; trs=`for base in $$bases; do echo $$base.trs; done`; \
	  rm -f $$logs $$trs $(TEST_SUITE_LOG); status=0; \
	  $(MAKE) $(AM_MAKEFLAGS) -j$(TEST_JOBS) $(TEST_SUITE_LOG) TEST_LOGS="`echo $$logs`" || status=$$?; \
	  $(SHELL) $(srcdir)/tests/support/count.sh $$trs; exit $$status

# The whole of each test, not its quick form; then the long tests, which fill the machine, one by one.
check-long:
	@status=0; $(MAKE) $(AM_MAKEFLAGS) check DUITE_QUICK=0 || status=$$?; \
	  $(MAKE) $(AM_MAKEFLAGS) check DUITE_QUICK=0 TEST_JOBS=1 TESTS='$(LONG_SH)' TEST_SUITE_LOG=test-suite-long.log || \
	  status=$$?; exit $$status

# In a build with ThreadSanitizer; only the programs that run are built.
check-threads:
	$(MAKE) $(AM_MAKEFLAGS) check-TESTS TESTS='$(TSAN_ALL)' check_PROGRAMS='$(TSAN_ALL)'
# The random programs a hundred times each; takes about half an hour.
check-threads-long:
	$(MAKE) $(AM_MAKEFLAGS) check DUITE_QUICK=0 TESTS=tests/runtime/test_threads_long.sh TEST_SUITE_LOG=test-suite-long.log
check-programs: $(check_PROGRAMS)
# An installed tree: the first program of the tutorial against it.
installcheck-local:
	@$(AM_TESTS_ENVIRONMENT) srcdir='$(srcdir)'; duite_DIR='$(cmakeconfigdir)'; \
	  PKG_CONFIG_PATH='$(pkgconfigdir)'$${PKG_CONFIG_PATH:+:$$PKG_CONFIG_PATH}; export srcdir duite_DIR PKG_CONFIG_PATH; \
	  $(LOG_COMPILER) $(srcdir)/tests/installed.sh
.PHONY: check-long check-threads check-threads-long check-programs golden-sentences

EXTRA_DIST += tests/arrows.txt tests/support/policies.h tests/support/tap.sh tests/support/predicted.sh tests/support/commands.sh \
	tests/support/bodies.sh tests/support/hangs.c tests/support/cloth.sh tests/support/probes.sh tests/support/table.sh tests/support/dress.awk tests/support/mpi.sh tests/support/kernel.h tests/support/rank.h tests/support/run.sh tests/support/screen.sh \
	tests/support/count.sh tests/support/mirror.sh tests/installed.sh \
    tests/support/lsan.supp tests/support/tsan.supp tests/support/valgrind.supp
ASAN_SH += tests/support/test_tap.sh tests/arrows.sh tests/documents.sh tests/embedding.sh tests/completion.sh tests/bootstrap.sh
PLAIN_SH += tests/install.sh tests/bare.sh tests/two_mpis.sh
LONG_SH += tests/pages.sh tests/bare_long.sh tests/arm64_long.sh

if HAVE_CHECK
check_LIBRARIES += tests/support/libunit.a
tests_support_libunit_a_SOURCES = tests/support/unit.c tests/support/unit_main.c tests/support/unit.h
TSAN_TESTS += tests/support/test_unit
tests_support_test_unit_LDADD = $(DUITE_TEST_LIBS)
endif

include tests/runtime/module.mk
include tests/tools/module.mk
include tests/negative/module.mk
include tests/model/module.mk
include tests/examples/module.mk
if CLOTH
CLOTH_TEST_LIBS = tests/support/libunit.a $(CLOTH_LIBS) $(CHECK_LIBS)
# The libraries of a program that names none. The source of one that names none is the file of its name.
LDADD = $(CLOTH_TEST_LIBS)
include tests/cloth/module.mk
include tests/cloth/base/module.mk
include tests/cloth/mesh/module.mk
include tests/cloth/contact/module.mk
include tests/cloth/verify/module.mk
include tests/cloth/untangle/module.mk
include tests/cloth/garment/module.mk
include tests/cloth/mannequin/module.mk
include tests/cloth/physics/module.mk
include tests/cloth/element/module.mk
include tests/cloth/solve/module.mk
include tests/cloth/flow/module.mk
include tests/cloth/output/module.mk
include tests/cloth/live/module.mk
include tests/cloth/scene/module.mk
include tests/cloth/view/module.mk
include tests/whole/module.mk
include tests/bench/module.mk
include tests/cluster/module.mk
include tests/fuzz/module.mk
endif
