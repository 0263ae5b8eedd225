#ifndef TESTS_FUZZ_FUZZ_H
#define TESTS_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* A harness is a program of one reader: it gives the reader any bytes, and uses what was read as
 * the programs do. It fails by a crash, a sanitizer, a limit of time or of memory. libFuzzer calls
 * it with bytes that it makes (tests/fuzz/run.sh); drive.c calls it with the files of a corpus. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Readers take paths. These functions end the process where the file system fails. */

/* The path of a file NAME with these bytes, in a folder of the process, which is removed at its
 * end. It is valid until the next call of any function here. NAME may have one folder before it,
 * which is made. */
const char *fuzz_file(const char *name, const void *data, size_t size);
/* The path of the folder. */
const char *fuzz_folder(void);

/* Some readers take several files. An input has them one after the other, with FUZZ_NEXT between
 * two. Writes the files `names` (n) with their parts of the input, and removes those that it has no
 * part of. */
#define FUZZ_NEXT "\n==NEXT==\n"
void fuzz_files(size_t n, const char *const names[], const uint8_t *data, size_t size);

#endif
