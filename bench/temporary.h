#ifndef BENCH_TEMPORARY_H
#define BENCH_TEMPORARY_H

/* Folders of a run, which go with all that is in them. */

enum { TEMPORARY_PATH = 4096 };

/* Makes "NAME.XXXXXX" in a folder, or in that for temporary files (TMPDIR; NULL); `path` has its
 * name. 0, or what serve_fail returns. */
int temporary_make(const char *in, const char *name, char path[TEMPORARY_PATH]);

/* Removes it; what stays is said on stderr. */
void temporary_remove(const char *path);

#endif
