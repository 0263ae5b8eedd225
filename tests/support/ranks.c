/* The main() of a program of cases: runs the one that is named first. */
#include "tests/support/ranks.h"

#include <stdio.h>
#include <string.h>

static struct ranks_case *cases;

void ranks_register(struct ranks_case *one)
{
    one->next = cases;
    cases = one;
}

int main(int argc, char **argv)
{
    for (const struct ranks_case *one = cases; argc > 1 && one; one = one->next)
        if (!strcmp(one->name, argv[1]))
            return one->run(argc - 1, argv + 1);
    fprintf(stderr, "usage: %s CASE [ARGUMENT...], of these:\n", argv[0]);
    for (const struct ranks_case *one = cases; one; one = one->next)
        fprintf(stderr, "    %s\n", one->name);
    return 2;
}
