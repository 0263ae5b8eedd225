# Charts of traced runs: no part of libduite. Programs that draw link it before libduite_core.
noinst_LTLIBRARIES += libduite_chart.la
libduite_chart_la_SOURCES = runtime/chart/chart.h runtime/chart/draw.c runtime/chart/layout.c runtime/chart/layout.h runtime/chart/model.c \
	runtime/chart/model.h \
	runtime/chart/canvas.h runtime/chart/options.c runtime/chart/png.c runtime/chart/shares.c runtime/chart/svg.c runtime/chart/traffic.c
libduite_chart_la_CPPFLAGS = $(AM_CPPFLAGS) $(CAIRO_CFLAGS)
libduite_chart_la_LIBADD = $(CAIRO_LIBS) -lm
