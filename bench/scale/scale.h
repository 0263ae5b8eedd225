#ifndef BENCH_SCALE_SCALE_H
#define BENCH_SCALE_SCALE_H

#include "bench/bench.h"

/* Shared by the cases of the bench "scale". */

enum { SCALE_COMMAND = 16384 };

/* Runs duite-cloth on cloth/scenes/sheet.yaml, of side x side vertices, with a grain, by `before`
 * (a command that ends with its program; "") and with further arguments. 0, or what serve_fail
 * returns. */
int scale_cloth(const char *before, unsigned side, unsigned grain, const char *arguments);

/* A new folder, which is in place of `folder`; and its end, with all that is in it. */
enum { SCALE_PATH = 4096 };
int scale_folder(char folder[SCALE_PATH]);
void scale_folder_remove(const char *folder);

extern const struct bench_case scale_messages, scale_wait, scale_predicted;

#endif
