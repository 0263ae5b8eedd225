#ifndef BENCH_INSTRUCTIONS_H
#define BENCH_INSTRUCTIONS_H

/* Instructions that a command takes, by valgrind: they do not depend on what else the machine does.
 * `command` is a line for the shell, quoted where it has to be. Returns 0 and the number, or what
 * serve_fail returns. Without wide instructions, some of which valgrind does not know. */
int instructions_count(const char *command, double *number);

#endif
