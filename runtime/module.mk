# libduite for users exports duite_* only; the tree itself links libduite_core, the same objects with all symbols.
lib_LTLIBRARIES += libduite.la
noinst_LTLIBRARIES += libduite_core.la
include_HEADERS = runtime/duite.h runtime/duite_policy.h
pkgconfig_DATA = runtime/duite.pc
dist_man_MANS += runtime/duite.3
libduite_la_SOURCES = $(include_HEADERS)
libduite_la_LIBADD = $(METIS_LIBS) $(HWLOC_LIBS) $(XXHASH_LIBS) $(MPI_LIBS) -lm
libduite_la_LDFLAGS = $(AM_LDFLAGS) -version-info 0:0:0 -export-symbols-regex '^duite_'
libduite_core_la_SOURCES = $(libduite_la_SOURCES)
libduite_core_la_LIBADD = $(libduite_la_LIBADD)

libduite_la_SOURCES += runtime/duite.c runtime/inside.c runtime/instance.h runtime/migrate.c runtime/objects.c runtime/options.c runtime/policies.c runtime/program.c runtime/blocking.c runtime/recorded.c runtime/traced.c
include runtime/base/module.mk
include runtime/data/module.mk
include runtime/graph/module.mk
include runtime/sched/module.mk
include runtime/map/module.mk
include runtime/balance/module.mk
include runtime/comm/module.mk
include runtime/check/module.mk
include runtime/trace/module.mk
include runtime/workers/module.mk
include runtime/predict/module.mk

bin_PROGRAMS += duite-trace
dist_man_MANS += runtime/duite-trace.1
duite_trace_SOURCES = runtime/duite-trace.c
duite_trace_LDADD = libduite_core.la
bin_PROGRAMS += duite-predict
dist_man_MANS += runtime/duite-predict.1
duite_predict_SOURCES = runtime/duite-predict.c
duite_predict_LDADD = libduite_core.la
