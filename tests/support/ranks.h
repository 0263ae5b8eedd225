#ifndef TESTS_SUPPORT_RANKS_H
#define TESTS_SUPPORT_RANKS_H

/* A program of many tests that need ranks (ranks.c): `PROGRAM CASE [ARGUMENT...]` runs one. A file
 * has one case, RANKS_CASE(NAME) { ... }: written as a main(), whose argv[0] is its name and whose
 * result is the exit status. 77: it cannot run here, and says why. */
struct ranks_case {
    const char *name;
    int (*run)(int argc, char **argv);
    struct ranks_case *next;
};

/* Makes the case known; called before main(). */
void ranks_register(struct ranks_case *one);

#define RANKS_CASE(NAME)                                                                           \
    static int ranks_##NAME(int argc, char **argv);                                                \
    __attribute__((constructor)) static void register_##NAME(void)                                 \
    {                                                                                              \
        static struct ranks_case one = {.name = #NAME, .run = ranks_##NAME};                       \
        ranks_register(&one);                                                                      \
    }                                                                                              \
    static int ranks_##NAME(__attribute__((unused)) int argc, __attribute__((unused)) char **argv)

#endif
