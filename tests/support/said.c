/* The file has no name, so nothing of it is left whatever becomes of the test. It is read by
 * offset, since those who write share its position. */
#include "tests/support/said.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int file = -1, before = -1;

void said_begin(void)
{
    char name[] = "/tmp/duite-said.XXXXXX";
    file = mkstemp(name);
    if (file < 0)
        abort();
    unlink(name);
    fcntl(file, F_SETFL, O_APPEND);
    fflush(stderr);
    before = dup(STDERR_FILENO);
    dup2(file, STDERR_FILENO);
}

static char *read_all(void)
{
    static _Thread_local char text[1 << 16];
    ssize_t n = pread(file, text, sizeof text - 1, 0);
    text[n > 0 ? n : 0] = 0;
    return text;
}

int said_lines(const char *begin, const char *part)
{
    int n = 0;
    char *rest = read_all();
    for (char *line; (line = strsep(&rest, "\n"));)
        n += rest && !strncmp(line, begin, strlen(begin)) && strstr(line, part);
    return n;
}

void said_end(void)
{
    fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    fputs(read_all(), stderr);
    close(file);
}
