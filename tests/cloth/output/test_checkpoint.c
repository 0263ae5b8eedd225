/* The file of a checkpoint reads back as it was written, and a cut or a change of it is noticed.
 * The newest whole one of several serves. One that cannot be written leaves those before it. */
#include "cloth/output/checkpoint.h"
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct cloth_error error, note;
static struct output_checkpoints *checkpoints;
static struct output_checkpoint read_back;

static void start(void)
{
    memset(&error, 0, sizeof error);
    memset(&note, 0, sizeof note);
    sample_make();
    UNIT_FINE(output_checkpoints_open(&checkpoints, sample.folder, &error));
}

static void end(void)
{
    output_checkpoint_free(&read_back);
    output_checkpoints_close(&checkpoints);
    sample_free();
}

/* Three parts, of which the second has no whole number of words: `mark` and what follows. */
static void write_one(unsigned char mark)
{
    unsigned char bytes[13];
    const uint64_t numbers[] = {mark, 1, 2};
    memset(bytes, mark, sizeof bytes);
    const struct output_part part[OUTPUT_CHECKPOINT_PARTS] = {
        {"key: value\n", 11}, {bytes, sizeof bytes}, {numbers, sizeof numbers}};
    UNIT_FINE(output_checkpoints_write(checkpoints, part, &error));
}

static const char *file_of(unsigned number)
{
    return sample_at("checkpoints/%06u.checkpoint", number);
}

static const char *part_of(unsigned number)
{
    return sample_at("checkpoints/%06u.checkpoint.part", number);
}

static bool is_there(unsigned number)
{
    return sample_has(file_of(number));
}

static int read_newest(void)
{
    memset(&error, 0, sizeof error);
    memset(&note, 0, sizeof note);
    output_checkpoint_free(&read_back);
    return output_checkpoint_newest(&read_back, sample.folder, &note, &error);
}

static void check_mark(unsigned char mark)
{
    ck_assert_msg(!read_newest(), "%s", error.text);
    ck_assert_uint_eq(read_back.part[0].n, 11);
    ck_assert_uint_eq(read_back.part[1].n, 13);
    ck_assert_uint_eq(read_back.part[2].n, 24);
    ck_assert_int_eq(memcmp(read_back.part[0].bytes, "key: value\n", 11), 0);
    for (size_t i = 0; i < 13; i++)
        ck_assert_uint_eq(((const unsigned char *)read_back.part[1].bytes)[i], mark);
    ck_assert_uint_eq(*(const uint64_t *)read_back.part[2].bytes, mark);
}

UNIT_FIXTURE(start, end)

UNIT_TEST(reads_back)
{
    write_one(7);
    check_mark(7);
    ck_assert_int_eq(note.code, 0);
}

UNIT_TEST(three_are_kept)
{
    for (unsigned char i = 1; i <= 5; i++)
        write_one(i);
    for (unsigned number = 1; number <= 5; number++)
        ck_assert_int_eq(is_there(number), number > 2);
    check_mark(5);
}

/* The run is killed when the next one is there, and the oldest is not gone yet. */
UNIT_TEST(three_are_kept_after_a_run_that_was_killed)
{
    for (unsigned char i = 1; i <= 4; i++)
        write_one(i);
    output_checkpoints_close(&checkpoints);
    ck_assert_int_eq(link(file_of(2), file_of(1)), 0);
    UNIT_FINE(output_checkpoints_open(&checkpoints, sample.folder, &error));
    for (unsigned number = 1; number <= 4; number++)
        ck_assert(is_there(number));
    write_one(5);
    for (unsigned number = 1; number <= 5; number++)
        ck_assert_int_eq(is_there(number), number > 2);
    check_mark(5);
}

/* The first part is as long as `length`. */
static void write_long(size_t length)
{
    static char bytes[5000];
    const struct output_part part[OUTPUT_CHECKPOINT_PARTS] = {{bytes, length}, {"b", 1}, {"c", 1}};
    UNIT_FINE(output_checkpoints_write(checkpoints, part, &error));
    ck_assert_msg(!read_newest(), "%s", error.text);
    ck_assert_uint_eq(read_back.part[0].n, length);
    ck_assert_int_eq(note.code, 0);
}

/* Longer or shorter, whichever was there; and nothing is left of it at the end. */
UNIT_TEST(the_oldest_gives_its_room)
{
    write_long(4000);
    const ino_t first = sample_stat(file_of(1)).st_ino;
    write_long(100);
    write_long(3000);
    write_long(50);
    ck_assert(sample_stat(part_of(5)).st_ino == first);
    write_long(10);
    ck_assert(sample_stat(file_of(5)).st_ino == first);
    write_long(5000);
    ck_assert(sample_has(part_of(7)));
    output_checkpoints_close(&checkpoints);
    ck_assert(!sample_has(part_of(7)));
}

UNIT_TEST(what_has_another_name_stays)
{
    write_one(1);
    ck_assert_int_eq(link(file_of(1), sample_at("other")), 0);
    for (unsigned char i = 2; i <= 6; i++)
        write_one(i);
    ck_assert(!is_there(1));
    UNIT_FINE(output_checkpoint_read(&read_back, sample_at("other"), &error));
    ck_assert_uint_eq(*(const uint64_t *)read_back.part[2].bytes, 1);
}

/* A run that goes on counts on, and still three are kept. */
UNIT_TEST(counts_on)
{
    for (unsigned char i = 1; i <= 3; i++)
        write_one(i);
    output_checkpoints_close(&checkpoints);
    UNIT_FINE(output_checkpoints_open(&checkpoints, sample.folder, &error));
    write_one(4);
    ck_assert(!is_there(1) && is_there(2) && is_there(4));
    check_mark(4);
}

/* A file that a run would not have named so is none of its. */
UNIT_TEST(other_numbers_are_nobodys)
{
    static const char *const names[] = {"0000009", "9", "18446744073709551616", "+00009", "000000"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        sample_write(sample_at("checkpoints/%s.checkpoint", names[i]), "x", 1);
    write_one(1);
    check_mark(1);
    ck_assert_int_eq(note.code, 0);
    output_checkpoints_close(&checkpoints);
    UNIT_FINE(output_checkpoints_open(&checkpoints, sample.folder, &error));
    write_one(2);
    ck_assert(is_there(2));
}

/* Numbers end somewhere: a run that could not count on does not begin. */
UNIT_TEST(the_last_number)
{
    static const char last[] = "checkpoints/18446744073709551615.checkpoint";
    write_one(1);
    output_checkpoints_close(&checkpoints);
    sample_write(sample_at("%s", last), "x", 1);
    UNIT_REFUSED(output_checkpoints_open(&checkpoints, sample.folder, &error), CLOTH_E_INPUT,
                 "18446744073709551615.checkpoint: no number is left");
    check_mark(1);
    unit_says(note.text, "is no checkpoint of duite-cloth");
}

/* A pipe has nobody at its other end, and is not waited for. */
UNIT_TEST(only_plain_files_are_read)
{
    write_one(1);
    ck_assert_int_eq(mkfifo(file_of(2), 0666), 0);
    check_mark(1);
    unit_says(note.text, "000002.checkpoint: it is no plain file");
}

/* ---- Damage ---- */

/* Whatever is wrong with the newest: the one before it serves, and that is said. */
static void falls_back(const char *what, size_t at)
{
    const int code = read_newest();
    /* another version is refused by name: the rest of the file may be anything */
    if (code) {
        ck_assert_msg(code == CLOTH_E_INPUT && strstr(error.text, "another version"), "%s %zu: %s",
                      what, at, error.text);
        return;
    }
    ck_assert_msg(note.code == CLOTH_E_IO, "%s %zu is not noticed", what, at);
    ck_assert_uint_eq(*(const uint64_t *)read_back.part[2].bytes, 1);
}

UNIT_TEST(every_length)
{
    char bytes[512];
    write_one(1);
    write_one(2);
    const size_t n = sample_read(file_of(2), bytes, sizeof bytes);
    ck_assert_uint_gt(n, 100);
    ck_assert_uint_lt(n, sizeof bytes);
    for (size_t length = 0; length < n; length++) {
        sample_write(file_of(2), bytes, length);
        falls_back("length", length);
    }
    sample_write(file_of(2), bytes, n);
    check_mark(2);
    sample_write(file_of(2), bytes, n + 1); /* a byte of what lies behind it in memory */
    falls_back("length", n + 1);
}

UNIT_TEST(every_bit)
{
    char bytes[512];
    write_one(1);
    write_one(2);
    const size_t n = sample_read(file_of(2), bytes, sizeof bytes);
    for (size_t bit = 0; bit < 8 * n; bit++) {
        bytes[bit / 8] = (char)(bytes[bit / 8] ^ 1 << bit % 8);
        sample_write(file_of(2), bytes, n);
        falls_back("bit", bit);
        bytes[bit / 8] = (char)(bytes[bit / 8] ^ 1 << bit % 8);
    }
}

UNIT_TEST(none_is_said)
{
    ck_assert_int_eq(read_newest(), CLOTH_E_INPUT);
    unit_says(error.text, "holds no checkpoint: a run writes them");
    write_one(1);
    sample_write(file_of(1), "a letter", 8);
    ck_assert_int_eq(read_newest(), CLOTH_E_INPUT);
    unit_says(error.text, "no checkpoint that is whole");
}

/* ---- What is in the way ---- */

UNIT_TEST(failed_write_keeps_others)
{
    write_one(1);
    ck_assert_int_eq(mkdir(part_of(2), 0777), 0);
    const struct output_part part[OUTPUT_CHECKPOINT_PARTS] = {{"a", 1}, {"b", 1}, {"c", 1}};
    ck_assert_int_eq(output_checkpoints_write(checkpoints, part, &error), CLOTH_E_IO);
    check_mark(1);
    ck_assert_int_eq(rmdir(part_of(2)), 0);
    memset(&error, 0, sizeof error);
    write_one(2);
    check_mark(2);
}

/* Half a file of a run that was killed goes, what is not ours stays. */
UNIT_TEST(cleans_up)
{
    static const char other[] = "checkpoints/notes.part";
    write_one(1);
    output_checkpoints_close(&checkpoints);
    sample_write(part_of(2), "", 0);
    sample_write(sample_at("%s", other), "", 0);
    UNIT_FINE(output_checkpoints_open(&checkpoints, sample.folder, &error));
    ck_assert(!sample_has(part_of(2)) && sample_has(sample_at("%s", other)));
    UNIT_FINE(output_checkpoints_forget(sample.folder, &error));
    ck_assert(!is_there(1) && sample_has(sample_at("%s", other)));
}
