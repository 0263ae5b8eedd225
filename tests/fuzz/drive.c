/* Runs a harness over the files of a corpus, each once, in the order of their names: what libFuzzer
 * found before is a test for any compiler. */
#include "tests/fuzz/fuzz.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SECONDS = 600 }; /* for one file: an end for what hangs */

static int run_file(const char *path)
{
    char *bytes = NULL;
    size_t size = 0;
    FILE *file = fopen(path, "rb");
    FILE *all = file ? open_memstream(&bytes, &size) : NULL;
    for (int c; all && (c = getc(file)) != EOF;)
        putc(c, all);
    const int bad = !all || ferror(file);
    if (file)
        fclose(file);
    if (!all || fclose(all) || bad) {
        fprintf(stderr, "%s: %s\n", path, strerror(errno));
        free(bytes);
        return 1;
    }
    uint8_t *exact = malloc(size ? size : 1); /* AddressSanitizer sees its end */
    if (!exact)
        abort();
    memcpy(exact, bytes, size);
    free(bytes);
    fprintf(stderr, "%s\n", path); /* the last line names what a crash is of */
    alarm(SECONDS);
    LLVMFuzzerTestOneInput(exact, size);
    free(exact);
    return 0;
}

static int run_folder(const char *path)
{
    struct dirent **entry = NULL;
    const int n = scandir(path, &entry, NULL, alphasort);
    int ran = 0, failed = n < 0;
    for (int i = 0; i < n; i++) {
        char name[4096];
        snprintf(name, sizeof name, "%s/%s", path, entry[i]->d_name);
        if (entry[i]->d_name[0] != '.') {
            failed |= run_file(name);
            ran++;
        }
        free(entry[i]);
    }
    free(entry);
    if (!ran)
        fprintf(stderr, "%s has no files\n", path);
    return failed || !ran;
}

/* Weak: the main of libFuzzer, where it is linked, is in its place. */
__attribute__((weak)) int main(int argc, char **argv)
{
    int failed = 0;
    if (argc < 2)
        fprintf(stderr, "usage: %s FOLDER...: runs each file of a corpus\n", argv[0]);
    for (int i = 1; i < argc; i++)
        failed |= run_folder(argv[i]);
    return argc < 2 ? 2 : failed;
}
