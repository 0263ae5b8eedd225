# The programs: what surrounds a run (run), what is asked of its states (check), what is said of it (report), what duite-view is
# asked for (view).
bin_PROGRAMS += duite-cloth duite-garment duite-mannequin
dist_man_MANS += cloth/app/duite-cloth.1 cloth/app/duite-garment.1 cloth/app/duite-mannequin.1
duite_cloth_SOURCES = \
    cloth/app/duite-cloth.c cloth/app/simulate.c cloth/app/simulate.h cloth/app/simulate_begin.c cloth/app/simulate_check.c cloth/app/simulate_run.h \
    cloth/app/stops.c cloth/app/check/drape.c cloth/app/check/drape.h cloth/app/check/intersections.c \
    cloth/app/check/intersections.h cloth/app/run/checkpoints.c cloth/app/run/checkpoints.h cloth/app/run/options.c \
    cloth/app/run/options.h cloth/app/run/outputs.c cloth/app/run/outputs.h cloth/app/run/outputs_fields.c \
    cloth/app/run/outputs_fields.h cloth/app/run/outputs_room.c cloth/app/run/outputs_room.h cloth/app/run/outputs_setup.c cloth/app/run/outputs_setup.h cloth/app/run/phases.c \
    cloth/app/run/phases.h cloth/app/run/phases_same.c cloth/app/run/progress.c cloth/app/run/progress.h cloth/app/run/start.c \
    cloth/app/run/start.h cloth/app/run/start_welds.c cloth/app/report/forecast.c cloth/app/report/forecast.h cloth/app/report/summary.c cloth/app/report/summary.h \
    cloth/app/report/summary_print.c cloth/app/report/summary_time.c
duite_cloth_CPPFLAGS = $(AM_CPPFLAGS) -DSHIPPED_SCENES='"$(scenesdir)"'
duite_cloth_LDADD = libduite_tools.a $(CLOTH_LIBS)
duite_garment_SOURCES = cloth/app/duite-garment.c cloth/app/cli.c cloth/app/cli.h
duite_garment_LDADD = $(CLOTH_LIBS)
duite_mannequin_SOURCES = cloth/app/duite-mannequin.c cloth/app/cli.c cloth/app/cli.h
duite_mannequin_LDADD = $(CLOTH_LIBS)

if HAVE_VIEW
bin_PROGRAMS += duite-view
dist_man_MANS += cloth/app/duite-view.1
duite_view_SOURCES = \
    cloth/app/duite-view.c cloth/app/cli.c cloth/app/cli.h cloth/app/view/frames.c cloth/app/view/frames.h \
    cloth/app/view/live.c cloth/app/view/live.h cloth/app/view/marks.c cloth/app/view/marks.h cloth/app/view/start.c \
    cloth/app/view/start.h cloth/app/check/intersections.c cloth/app/check/intersections.h cloth/app/run/options.c \
    cloth/app/run/options.h cloth/app/run/outputs_setup.c cloth/app/run/outputs_setup.h
duite_view_CPPFLAGS = $(duite_cloth_CPPFLAGS)
duite_view_LDADD = $(CHART_LIBS) $(VIEW_LIBS)
endif
EXTRA_DIST += cloth/app/duite-view.1 cloth/app/demo.sh

demo: all
	@srcdir='$(srcdir)' MPIRUN='$(MPIRUN)' VIEW_MISSING='$(VIEW_MISSING)' $(SHELL) $(srcdir)/cloth/app/demo.sh
