/* The environment is prepared before the first case is made, since check reads its time limit
 * there. The user's own environment wins. The list of cases is made before main(). */

#include "tests/support/unit.h"

#include "tests/support/rank.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct unit_cases *first_cases, **last_cases = &first_cases;

void unit_register(struct unit_cases *cases)
{
    *last_cases = cases;
    last_cases = &cases->next;
}

__attribute__((constructor)) static void prepare(void)
{
    setenv("CK_DEFAULT_TIMEOUT", "1200", 0);
    setenv("HWLOC_HIDE_ERRORS", "2", 0);
    setenv("HWLOC_COMPONENTS", "-gl", 0); /* as in mpi.sh */
    if (geteuid() == 0) {
        setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
        setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
    }
}

int unit_main(void)
{
    Suite *suite = suite_create("tests");
    TCase *tcase = tcase_create("tests");
    for (struct unit_cases *cases = first_cases; cases; cases = cases->next)
        cases->add(tcase);
    suite_add_tcase(suite, tcase);
    return unit_run(suite);
}

int unit_run(Suite *suite)
{
    const char *rank = rank_said();
    SRunner *runner = srunner_create(suite);

    if (rank != NULL) /* MPI knows this process, not a child of it */
        srunner_set_fork_status(runner, CK_NOFORK);
    if (rank == NULL || strcmp(rank, "0") == 0)
        srunner_set_tap(runner, "-");
    srunner_run_all(runner, CK_SILENT);

    int failed = srunner_ntests_failed(runner);
    if (failed > 0 && rank != NULL && strcmp(rank, "0") != 0)
        fprintf(stderr, "rank %s: %d cases failed\n", rank, failed);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int unit_quick(void)
{
    const char *quick = getenv("DUITE_QUICK");
    return quick != NULL && strcmp(quick, "1") == 0;
}

int unit_alone(void)
{
    const char *size = ranks_said();
    return size == NULL || strcmp(size, "1") == 0;
}
