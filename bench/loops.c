/* The loops are children of the bench itself, so that no subject's time has their start. */
#include "bench/loops.h"

#include "bench/subject.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

static pid_t loop[LOOPS_MOST];
static unsigned n;

static void run_for_ever(pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) /* it ended before */
        _exit(0);
    for (volatile int on = 1; on;)
        ;
}

int loops_start(unsigned a_core)
{
    const unsigned wanted = a_core * subject_cores();
    const pid_t parent = getpid();
    fflush(NULL);
    if (wanted > LOOPS_MOST)
        return fprintf(stderr, "duite-bench: %u loops are more than %d\n", wanted, LOOPS_MOST), 1;
    while (n < wanted) {
        loop[n] = fork();
        if (loop[n] == 0)
            run_for_ever(parent);
        if (loop[n] < 0) {
            fprintf(stderr, "duite-bench: loop %u of %u does not start: %s\n", n + 1, wanted,
                    strerror(errno));
            loops_end();
            return 1;
        }
        n++;
    }
    return 0;
}

void loops_end(void)
{
    for (unsigned i = 0; i < n; i++)
        kill(loop[i], SIGKILL);
    for (unsigned i = 0; i < n; i++)
        waitpid(loop[i], NULL, 0);
    n = 0;
}
