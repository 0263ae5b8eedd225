#ifndef BENCH_LOOPS_H
#define BENCH_LOOPS_H

/* Processes that never wait, on all cores of the bench: other people's programs. */
enum { LOOPS_A_CORE = 4, LOOPS_MOST = 1024 };

/* Starts so many on each core; 1, said on stderr, if that fails. They die with the bench. */
int loops_start(unsigned a_core);
/* Ends those that were started, if any. */
void loops_end(void);

#endif
