/* nearest.c: edit distance between names.
 * Optimal string alignment (Damerau 1964 with Wagner and Fischer's dynamic programme). */
#include "cli/nearest.h"

#include <string.h>

#define TC_NAME_MAX 63

static unsigned tc_min3(unsigned a, unsigned b, unsigned c)
{
    unsigned m = a < b ? a : b;
    return m < c ? m : c;
}

unsigned tc_name_distance(const char *a, const char *b)
{
    unsigned row[3][TC_NAME_MAX + 1];
    size_t na = strlen(a), nb = strlen(b);
    na = na < TC_NAME_MAX ? na : TC_NAME_MAX;
    nb = nb < TC_NAME_MAX ? nb : TC_NAME_MAX;
    for (size_t j = 0; j <= nb; j++)
        row[0][j] = (unsigned)j;
    for (size_t i = 1; i <= na; i++) {
        unsigned *now = row[i % 3], *last = row[(i - 1) % 3], *before = row[(i + 1) % 3];
        now[0] = (unsigned)i;
        for (size_t j = 1; j <= nb; j++) {
            unsigned replace = last[j - 1] + (a[i - 1] != b[j - 1]);
            now[j] = tc_min3(last[j] + 1, now[j - 1] + 1, replace);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < now[j])
                now[j] = before[j - 2] + 1;
        }
    }
    return row[na % 3][nb];
}

void tc_nearest_offer(tc_nearest *search, const char *known)
{
    unsigned distance = tc_name_distance(search->name, known);
    if (!search->best || distance < search->distance) {
        search->best = known;
        search->distance = distance;
    }
}
