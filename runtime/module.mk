# libduite for users exports what duite.sym lists, which tests/documents.sh compares with the headers. The programs of the tree link
# libduite_core.a, the same objects with all names.
lib_LTLIBRARIES += libduite.la
noinst_LTLIBRARIES += libduite_core.la
include_HEADERS = runtime/duite.h runtime/duite.hpp runtime/duite_kernel.hpp runtime/duite_policy.h
pkgconfig_DATA = runtime/duite.pc
cmakeconfigdir = $(libdir)/cmake/duite
cmakeconfig_DATA = runtime/duiteConfig.cmake runtime/duiteConfigVersion.cmake
dist_man_MANS += runtime/duite.3
man_MANS += $(RUNTIME_PAGES)
# A page for each function, macro and type of the headers; tests/documents.sh compares.
RUNTIME_PAGES = \
	runtime/man/duite_abandon.3 runtime/man/duite_acquire.3 runtime/man/duite_adopt.3 runtime/man/duite_await_fortran.3 runtime/man/duite_await_mpi.3 runtime/man/duite_release.3 runtime/man/DUITE_ARGS.3 runtime/man/duite_balancer.3 runtime/man/duite_balancer_find.3 \
	runtime/man/duite_balancer_names.3 runtime/man/duite_blocks.3 runtime/man/duite_body.3 runtime/man/duite_build.3 \
	runtime/man/duite_call.3 runtime/man/duite_code.3 runtime/man/duite_code_text.3 runtime/man/duite_colocate.3 \
	runtime/man/duite_contribute.3 runtime/man/duite_cores.3 runtime/man/duite_done.3 runtime/man/duite_count.3 runtime/man/duite_count_all.3 runtime/man/duite_count_sized.3 \
	runtime/man/duite_counters.3 runtime/man/duite_complete.3 runtime/man/duite_end.3 runtime/man/duite_event.3 runtime/man/duite_event_new.3 runtime/man/duite_fail.3 runtime/man/duite_fail_text.3 runtime/man/DUITE_FORK.3 \
	runtime/man/duite_fork.3 runtime/man/duite_fork_at.3 runtime/man/duite_fork_with.3 runtime/man/duite_free.3 \
	runtime/man/duite_get.3 runtime/man/duite_get_at.3 runtime/man/duite_get_begin.3 runtime/man/duite_get_end.3 runtime/man/duite_get_count.3 runtime/man/duite_graph.3 \
	runtime/man/duite_graph_args.3 runtime/man/duite_graph_bind.3 runtime/man/duite_graph_free.3 runtime/man/duite_graph_new.3 \
	runtime/man/duite_graph_rounds.3 runtime/man/duite_hint.3 runtime/man/duite_home.3 runtime/man/duite_in.3 \
	runtime/man/duite_is_local.3 runtime/man/duite_kernel.3 runtime/man/duite_kernel_add.3 runtime/man/duite_law.3 runtime/man/duite_law_find.3 runtime/man/DUITE_LAWS.3 runtime/man/duite_leaf.3 \
	runtime/man/duite_mapping.3 runtime/man/duite_mapping_find.3 runtime/man/duite_mapping_names.3 runtime/man/duite_message.3 \
	runtime/man/duite_mode.3 runtime/man/duite_mpi_begin.3 runtime/man/duite_mpi_end.3 runtime/man/duite_near.3 \
	runtime/man/duite_new.3 runtime/man/duite_new_sized.3 runtime/man/duite_object.3 runtime/man/duite_object_graph.3 \
	runtime/man/duite_options.3 runtime/man/duite_options_comm.3 runtime/man/duite_options_default.3 runtime/man/duite_options_set.3 runtime/man/duite_out.3 runtime/man/duite_oversubscribed.3 \
	runtime/man/duite_param.3 runtime/man/duite_prefetch.3 runtime/man/duite_random.3 runtime/man/duite_rank.3 \
	runtime/man/duite_ranks.3 runtime/man/duite_ready.3 runtime/man/duite_replay.3 runtime/man/duite_replay_while.3 \
	runtime/man/duite_request.3 runtime/man/duite_resize.3 runtime/man/duite_scheduler.3 runtime/man/duite_scheduler_find.3 \
	runtime/man/duite_scheduler_names.3 runtime/man/duite_set.3 runtime/man/duite_set_at.3 runtime/man/duite_split.3 runtime/man/duite_join.3 runtime/man/duite_set_sized.3 runtime/man/duite_start.3 \
	runtime/man/duite_stop.3 runtime/man/duite_task_graph.3 runtime/man/duite_task_options.3 runtime/man/duite_test.3 runtime/man/duite_threads.3 \
	runtime/man/duite_trace_end.3 runtime/man/duite_trace_step.3 runtime/man/duite_type.3 runtime/man/duite_version.3 \
	runtime/man/duite_wait.3 runtime/man/duite_wait_for.3
$(RUNTIME_PAGES): runtime/man.stamp
	@test -f $@ || { rm -f runtime/man.stamp && $(MAKE) $(AM_MAKEFLAGS) runtime/man.stamp; }
runtime/man.stamp: runtime/man.awk runtime/duite.h runtime/duite_policy.h
	$(AM_V_GEN)$(MKDIR_P) runtime/man && $(AWK) -v out=runtime/man -f $(srcdir)/runtime/man.awk $(srcdir)/runtime/duite.h \
		$(srcdir)/runtime/duite_policy.h && touch $@
CLEANFILES += $(RUNTIME_PAGES) runtime/man.stamp
EXTRA_DIST += runtime/man.awk runtime/duite.sym
# A compiled module of Fortran is one compiler's, so users compile its source.
dist_pkgdata_DATA = runtime/duite.f90
libduite_la_SOURCES = $(include_HEADERS)
libduite_la_LIBADD = $(METIS_LIBS) $(HWLOC_LIBS) $(XXHASH_LIBS) $(MPI_LIBS) -lm
libduite_la_LDFLAGS = $(AM_LDFLAGS) -version-info 1:0:0 -export-symbols $(srcdir)/runtime/duite.sym
EXTRA_libduite_la_DEPENDENCIES = runtime/duite.sym
libduite_core_la_SOURCES = $(libduite_la_SOURCES)
libduite_core_la_LDFLAGS = $(AM_LDFLAGS)
libduite_core.a: libduite_core.la
	$(AM_V_GEN)cp .libs/libduite_core.a $@
CLEANFILES += libduite_core.a
CORE_LIBS = libduite_core.a $(libduite_la_LIBADD)

include runtime/base/module.mk
include runtime/data/module.mk
include runtime/queue/module.mk
include runtime/comm/module.mk
include runtime/task/module.mk
include runtime/plan/module.mk
include runtime/offload/module.mk
include runtime/sched/module.mk
include runtime/map/module.mk
include runtime/balance/module.mk
include runtime/check/module.mk
include runtime/trace/module.mk
include runtime/workers/module.mk
include runtime/api/module.mk
