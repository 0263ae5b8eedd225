# Harnesses of what reads files (fuzz.h). `make check` runs them over the committed corpus. `make fuzz` builds them by clang with
# libFuzzer, and lets each look for FUZZ_SECONDS; FUZZ='obj trace' names some of them.
FUZZ_FILES = tests/fuzz/fit.h tests/fuzz/fuzz.h tests/fuzz/fuzz.c tests/fuzz/drive.c
FUZZ_LIBS = $(CHART_LIBS) libduite_tools.a $(CLOTH_LIBS)
FUZZ_HARNESSES = tests/fuzz/fuzz_checkpoint tests/fuzz/fuzz_colours tests/fuzz/fuzz_live tests/fuzz/fuzz_obj tests/fuzz/fuzz_output \
	tests/fuzz/fuzz_pattern tests/fuzz/fuzz_pc2 tests/fuzz/fuzz_resume tests/fuzz/fuzz_scene tests/fuzz/fuzz_seams \
	tests/fuzz/fuzz_trace tests/fuzz/fuzz_weights
ASAN_SH += tests/fuzz/test_corpus.sh
LONG_SH += tests/fuzz/test_programs_long.sh
check_PROGRAMS += $(FUZZ_HARNESSES) tests/fuzz/mutate
tests_fuzz_mutate_SOURCES = tests/fuzz/mutate.c tests/support/random.h
tests_fuzz_mutate_LDADD =
tests_fuzz_fuzz_checkpoint_SOURCES = tests/fuzz/fuzz_checkpoint.c $(FUZZ_FILES)
tests_fuzz_fuzz_checkpoint_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_colours_SOURCES = tests/fuzz/fuzz_colours.c $(FUZZ_FILES)
tests_fuzz_fuzz_colours_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_live_SOURCES = tests/fuzz/fuzz_live.c $(FUZZ_FILES)
tests_fuzz_fuzz_live_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_obj_SOURCES = tests/fuzz/fuzz_obj.c $(FUZZ_FILES)
tests_fuzz_fuzz_obj_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_output_SOURCES = tests/fuzz/fuzz_output.c $(FUZZ_FILES)
tests_fuzz_fuzz_output_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_pattern_SOURCES = tests/fuzz/fuzz_pattern.c $(FUZZ_FILES)
tests_fuzz_fuzz_pattern_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_pc2_SOURCES = tests/fuzz/fuzz_pc2.c $(FUZZ_FILES)
tests_fuzz_fuzz_pc2_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_resume_SOURCES = tests/fuzz/fuzz_resume.c $(FUZZ_FILES)
tests_fuzz_fuzz_resume_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_scene_SOURCES = tests/fuzz/fuzz_scene.c $(FUZZ_FILES)
tests_fuzz_fuzz_scene_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_seams_SOURCES = tests/fuzz/fuzz_seams.c $(FUZZ_FILES)
tests_fuzz_fuzz_seams_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_trace_SOURCES = tests/fuzz/fuzz_trace.c $(FUZZ_FILES)
tests_fuzz_fuzz_trace_LDADD = $(FUZZ_LIBS)
tests_fuzz_fuzz_weights_SOURCES = tests/fuzz/fuzz_weights.c $(FUZZ_FILES)
tests_fuzz_fuzz_weights_LDADD = $(FUZZ_LIBS)
dist_check_SCRIPTS += tests/fuzz/run.sh
EXTRA_DIST += tests/fuzz/corpus

FUZZ_SECONDS = 600
fuzz:
	$(MAKE) $(AM_MAKEFLAGS) distdir distdir=fuzz-source
	MAKE='$(MAKE)' $(SHELL) $(srcdir)/tests/fuzz/run.sh $(FUZZ_SECONDS) $(FUZZ)
fuzz-clean:
	rm -rf fuzz-source fuzz-build
