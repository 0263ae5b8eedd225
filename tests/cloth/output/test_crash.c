/* The process dies, or the disk is full, at each call that changes the disk in turn: what is then
 * on the disk must be whole. This program has its own versions of those calls, which stand before
 * the C library's. */
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum mode { OFF, DIE, FULL };
static _Atomic enum mode mode = OFF;
static int reason = ENOSPC; /* why calls fail */
static _Atomic long calls_left;

/* True if this call is the one that fails; a dying process does not come back. */
static int strikes(void)
{
    if (mode == OFF || calls_left-- != 0)
        return 0;
    if (mode == DIE)
        _exit(42);
    errno = reason;
    return 1;
}

ssize_t pwrite(int file, const void *bytes, size_t n, off_t offset)
{
    /* Half of the bytes get through before it strikes. */
    if (mode != OFF && calls_left == 0 && n > 1)
        syscall(SYS_pwrite64, file, bytes, n / 2, offset);
    return strikes() ? -1 : (ssize_t)syscall(SYS_pwrite64, file, bytes, n, offset);
}

int fdatasync(int file)
{
    return strikes() ? -1 : (int)syscall(SYS_fdatasync, file);
}

int fsync(int file)
{
    return strikes() ? -1 : (int)syscall(SYS_fsync, file);
}

int unlink(const char *path)
{
    return strikes() ? -1 : unlinkat(AT_FDCWD, path, 0);
}

int rename(const char *from, const char *to)
{
    return strikes() ? -1 : renameat(AT_FDCWD, from, AT_FDCWD, to);
}

/* Runs 3 frames of run 2, to die at call n. settles: a thread brings them to the disk. Returns
 * whether it got through. */
static int survives(long n, bool settles)
{
    fflush(NULL);
    pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (child == 0) {
        sample.settles = settles;
        mode = DIE;
        calls_left = n;
        sample_run(2, 3);
        _exit(0);
    }
    int status = 0;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert(WIFEXITED(status) && (WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 42));
    return WEXITSTATUS(status) == 0;
}

/* The folder is whole frames of one run, or has no cache at all. Returns their number, -1: no
 * cache. */
static int check_folder(void)
{
    struct output_cache cache;
    if (access(sample_path("cloth.pc2"), F_OK) != 0)
        return -1;
    UNIT_FINE(output_cache_open(&cache, sample.frames, &error));
    int n = (int)cache.n_frames;
    unsigned run = n == 4 ? 1 : 2;
    double want[3 * SAMPLE_POINTS], got[3 * SAMPLE_POINTS];
    for (int i = 0; i < n; i++) {
        sample_positions(run, (uint64_t)i, want);
        UNIT_FINE(output_cache_frame(&cache, (uint64_t)i, got, &error));
        ck_assert_mem_eq(got, want, sizeof want);
    }
    output_cache_close(&cache);
    return n;
}

UNIT_FIXTURE(sample_make, sample_free)

UNIT_TEST(dies_anywhere)
{
    int seen[6] = {0}, through = 0;
    for (long n = 0; !through; n++) {
        ck_assert_int_lt(n, 200);
        sample_run(1, 4);
        through = survives(n, false);
        seen[check_folder() + 1]++;
    }
    for (int i = 0; i < 6; i++) /* none, 0 .. 3 of the new run, 4 of the old one */
        ck_assert_msg(seen[i] > 0, "never ended with %d frames", i - 1);
}

UNIT_TEST(dies_anywhere_with_a_thread)
{
    int through = 0;
    for (long n = 0; !through; n++) {
        ck_assert_int_lt(n, 200);
        sample_run(1, 4);
        through = survives(n, true);
        check_folder();
    }
    ck_assert_int_eq(check_folder(), 3);
}

UNIT_TEST(fails_to_open_whole)
{
    int opened = 0;
    for (long n = 0; !opened; n++) {
        ck_assert_int_lt(n, 200);
        struct cloth_error error = {0};
        struct output_frames *frames = NULL;
        sample_run(1, 4);
        mode = FULL;
        calls_left = n;
        int code = output_open(&frames, &sample.setup, &error);
        opened = calls_left >= 0;
        mode = OFF;
        ck_assert((code == 0) == (frames != NULL));
        ck_assert(code == 0 || (code == CLOTH_E_IO && strstr(error.text, "No space left")));
        int left = check_folder();
        ck_assert(code == 0 ? left == 0 : left == 4 || left == -1);
        output_close(&frames, &error);
        ck_assert_int_ne(access(sample_path("cloth.pc2.part"), F_OK), 0);
    }
}

/* A disk that fails is no mistake of the user; a folder that may not be written to is. */
UNIT_TEST(tells_whose_fault)
{
    static const struct {
        int reason, code;
    } all[] = {
        {EPERM, CLOTH_E_INPUT}, {EACCES, CLOTH_E_INPUT}, {EIO, CLOTH_E_IO}, {EDQUOT, CLOTH_E_IO}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        struct cloth_error error = {0};
        struct output_frames *frames = NULL;
        sample_run(1, 1);
        reason = all[i].reason;
        mode = FULL;
        calls_left = 4; /* after four files: the old cache is not to be removed */
        int code = output_open(&frames, &sample.setup, &error);
        mode = OFF;
        ck_assert_int_eq(code, all[i].code);
        ck_assert_msg(strstr(error.text, "cloth.pc2: ") && strstr(error.text, strerror(reason)),
                      "%s", error.text);
    }
    reason = ENOSPC;
}

/* A frame that fails takes its own bytes away, and the next try succeeds. */
UNIT_TEST(full_disk_keeps_whole_frames)
{
    int through = 0;
    for (long n = 0; !through; n++) {
        ck_assert_int_lt(n, 50);
        struct cloth_error error = {0};
        struct output_frames *frames = NULL;
        double position[3 * SAMPLE_POINTS];
        UNIT_FINE(output_open(&frames, &sample.setup, &error));
        sample_positions(2, 0, position);
        UNIT_FINE(output_frame(frames, 0, 0, position, &error));
        sample_positions(2, 1, position);
        mode = FULL;
        calls_left = n;
        int code = output_frame(frames, 1, 0.04, position, &error);
        through = calls_left >= 0;
        mode = OFF;
        ck_assert_int_eq(check_folder(), through ? 2 : 1);
        ck_assert_int_eq(sample_stat(sample_path("cloth.pc2")).st_size,
                         32 + (through ? 2 : 1) * 12 * SAMPLE_POINTS);
        ck_assert_int_eq(sample_stat(sample_path("frames.csv")).st_size, through ? 38 : 15);
        if (!through) {
            ck_assert_int_eq(code, CLOTH_E_IO);
            unit_says(error.text, "No space left");
            error.code = 0;
            UNIT_FINE(output_frame(frames, 1, 0.04, position, &error));
            ck_assert_int_eq(check_folder(), 2);
        }
        output_close(&frames, &error);
    }
}

/* A later call tells what a thread could not bring to the disk; its own frame is taken away, too.
 */
UNIT_TEST(full_disk_is_said_later)
{
    int through = 0;
    for (long n = 0; !through; n++) {
        ck_assert_int_lt(n, 50);
        struct cloth_error error = {0};
        struct output_frames *frames = NULL;
        double position[3 * SAMPLE_POINTS];
        UNIT_FINE(output_settler_open(&sample.setup.settler, &error));
        UNIT_FINE(output_open(&frames, &sample.setup, &error));
        sample_positions(2, 0, position);
        UNIT_FINE(output_frame(frames, 0, 0, position, &error));
        UNIT_FINE(output_settler_wait(sample.setup.settler, &error));
        sample_positions(2, 1, position);
        mode = FULL;
        calls_left = n;
        const int written = output_frame(frames, 1, 0.04, position, &error);
        const int settled = output_settler_wait(sample.setup.settler, &error);
        through = calls_left >= 0;
        mode = OFF;
        ck_assert_int_eq(written || settled, !through);
        ck_assert_uint_eq(output_frames_settled(frames), through ? 2 : 1);
        ck_assert_int_eq(check_folder(), through ? 2 : 1);
        if (settled) {
            unit_says(error.text, "No space left");
            sample_positions(2, 2, position);
            ck_assert_int_eq(output_frame(frames, 2, 0.08, position, &error), CLOTH_E_IO);
        }
        ck_assert_int_eq(output_settler_close(&sample.setup.settler, &error), settled);
        output_close(&frames, &error);
        ck_assert_int_eq(sample_stat(sample_path("frames.csv")).st_size, through ? 38 : 15);
        ck_assert_int_eq(check_folder(), through ? 2 : 1);
    }
}

UNIT_TEST(report_is_whole_or_not_at_all)
{
    char path[96], part[144], text[64];
    snprintf(path, sizeof path, "%s/report.json", sample.folder);
    snprintf(part, sizeof part, "%s.%ld.part", path, (long)getpid());
    int through = 0;
    for (long n = 0; !through; n++) {
        ck_assert_int_lt(n, 50);
        struct cloth_error error = {0};
        struct output_report *report = NULL;
        sample_write(path, "old", 3);
        UNIT_FINE(output_report_new(&report, &error));
        output_report_integer(report, "steps", 3);
        mode = FULL;
        calls_left = n;
        int code = output_report_write(report, path, &error);
        through = calls_left >= 0;
        mode = OFF;
        output_report_free(report);
        ck_assert_int_eq(code, through ? 0 : CLOTH_E_IO);
        sample_read(path, text, sizeof text);
        ck_assert_int_ne(access(part, F_OK), 0);
        ck_assert_str_eq(text, through ? "{\n  \"steps\": 3\n}\n" : "old");
    }
}
