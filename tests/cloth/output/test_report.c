/* A report is valid JSON whatever is put into it, and its numbers read back as they were. */
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static struct output_report *report;
static struct cloth_error error;
static char path[96], text[4096];

static void start(void)
{
    memset(&error, 0, sizeof error);
    sample_make();
    snprintf(path, sizeof path, "%s/report.json", sample.folder);
    UNIT_FINE(output_report_new(&report, &error));
}

static void end(void)
{
    output_report_free(report);
    sample_free();
}

static void check_written(const char *want)
{
    UNIT_FINE(output_report_write(report, path, &error));
    sample_read(path, text, sizeof text);
    ck_assert_str_eq(text, want);
}

UNIT_FIXTURE(start, end)

UNIT_TEST(empty)
{
    check_written("{}\n");
}

UNIT_TEST(keeps_order)
{
    output_report_text(report, "scene", "sheet.yaml");
    output_report_integer(report, "steps", UINT64_MAX);
    output_report_null(report, "messages");
    output_report_number(report, "h", 0.5);
    output_report_number(report, "lost", NAN);
    output_report_number(report, "most", -INFINITY);
    check_written("{\n  \"scene\": \"sheet.yaml\",\n  \"steps\": 18446744073709551615,\n"
                  "  \"messages\": null,\n  \"h\": 0.5,\n  \"lost\": null,\n  \"most\": null\n}\n");
}

UNIT_TEST(escapes)
{
    output_report_text(report, "a\"b", "\\ \" \n \t \1 \x7f");
    output_report_text(report, "utf8", "d\xc3\xa9j\xc3\xa0 \xe2\x82\xac \xf0\x9f\x98\x80");
    output_report_text(report, "not utf8", "\xff \xc3( \xc0\xaf \xed\xa0\x80 \xe2\x82");
    check_written("{\n  \"a\\\"b\": \"\\\\ \\\" \\n \\t \\u0001 \\u007f\",\n"
                  "  \"utf8\": \"d\xc3\xa9j\xc3\xa0 \xe2\x82\xac \xf0\x9f\x98\x80\",\n"
                  "  \"not utf8\": \"\\ufffd \\ufffd( \\ufffd\\ufffd \\ufffd\\ufffd\\ufffd "
                  "\\ufffd\\ufffd\"\n}\n");
}

UNIT_TEST(numbers_come_back)
{
    static const double value[] = {0.1, 1.0 / 3, 5e-324, 1.7976931348623157e308, -0.0, 1e22};
    for (size_t i = 0; i < sizeof value / sizeof *value; i++)
        output_report_number(report, "x", value[i]);
    UNIT_FINE(output_report_write(report, path, &error));
    sample_read(path, text, sizeof text);
    const char *next = text;
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        next = strchr(next, ':') + 1;
        double got = strtod(next, NULL);
        ck_assert_mem_eq(&got, &value[i], sizeof got);
    }
}

UNIT_TEST(keeps_a_link)
{
    const char *link = sample_at("link.json");
    sample_write(path, "old", 3);
    ck_assert_int_eq(symlink("report.json", link), 0);
    UNIT_FINE(output_report_write(report, link, &error));
    struct stat status;
    ck_assert_int_eq(lstat(link, &status), 0);
    ck_assert(S_ISLNK(status.st_mode));
    sample_read(path, text, sizeof text);
    ck_assert_str_eq(text, "{}\n");
}

UNIT_TEST(does_not_replace_a_device)
{
    struct stat status;
    UNIT_FINE(output_report_write(report, "/dev/null", &error));
    ck_assert_int_eq(stat("/dev/null", &status), 0);
    ck_assert(S_ISCHR(status.st_mode));
    UNIT_REFUSED(output_report_write(report, "/dev/full", &error), CLOTH_E_IO, "No space left");
}

UNIT_TEST(says_what_is_in_the_way)
{
    UNIT_REFUSED(output_report_write(report, sample.folder, &error), CLOTH_E_INPUT,
                 "Is a directory");
    sample_write(path, "old", 3);
    UNIT_REFUSED(output_report_write(report, sample_at("report.json/x.json"), &error),
                 CLOTH_E_INPUT, "Not a directory");
}

/* A link to another, in a folder, to a file that is not there yet. */
UNIT_TEST(follows_links_to_nothing)
{
    const char *link = sample_at("first.json"), *below = sample_at("sub/second.json");
    struct stat status;
    ck_assert_int_eq(symlink("sub/second.json", link), 0);
    ck_assert_int_eq(output_report_check(link, NULL, &error), CLOTH_E_INPUT);
    ck_assert_msg(strstr(error.text, "it is a link to ") && strstr(error.text, "/sub/second.json"),
                  "%s", error.text);
    error.code = 0;
    ck_assert_int_eq(mkdir(sample_at("sub"), 0777), 0);
    ck_assert_int_eq(symlink("third.json", below), 0);
    UNIT_FINE(output_report_check(link, NULL, &error));
    UNIT_FINE(output_report_write(report, link, &error));
    ck_assert(lstat(link, &status) == 0 && S_ISLNK(status.st_mode));
    ck_assert(lstat(below, &status) == 0 && S_ISLNK(status.st_mode));
    sample_read(sample_at("sub/third.json"), text, sizeof text);
    ck_assert_str_eq(text, "{}\n");
}

UNIT_TEST(links_in_a_ring)
{
    const char *link = sample_at("ring.json");
    ck_assert_int_eq(symlink("ring.json", link), 0);
    UNIT_REFUSED(output_report_check(link, NULL, &error), CLOTH_E_INPUT,
                 "Too many levels of symbolic links");
    ck_assert_int_eq(output_report_write(report, link, &error), CLOTH_E_IO);
}

UNIT_TEST(checks_before)
{
    UNIT_FINE(output_report_check("/dev/null", NULL, &error));
    UNIT_FINE(output_report_check(path, NULL, &error));
    ck_assert_int_eq(output_report_check(sample.folder, NULL, &error), CLOTH_E_INPUT);
    ck_assert_str_eq(error.text, "this is a folder; the name of a file is expected");
    error.code = 0;
    for (int i = 0; i < 3; i++) { /* another folder is made, a folder in its folder, itself */
        static const char *const name[] = {"newer", "new/frames", "new/"};
        const char *file = sample_at("new/report.json"), *made = sample_at("%s", name[i]);
        ck_assert_int_eq(output_report_check(file, made, &error), i ? 0 : CLOTH_E_INPUT);
        error.code = 0;
    }
}
