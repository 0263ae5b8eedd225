/* In a file of its own: of a library the linker takes it where a program has no main(). */
#include "tests/support/unit.h"

int main(void)
{
    return unit_main();
}
