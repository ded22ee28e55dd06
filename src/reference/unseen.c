/* unseen.c: what a random draw without repetition says of the pixels that were not drawn: an upper confidence bound
 * from the hypergeometric distribution, by the order statistics of a finite population (Wilks 1941 has the infinite
 * one). */
#include "reference/truth.h"

#include <math.h>

/* log of the probability C(w - k, m) / C(w, m) that m of w miss k given ones: the product of (w - m - i) / (w - i) over
 * i < k, or the same with k and m exchanged, whichever has fewer terms. */
static double log_missed(size_t w, size_t m, size_t k)
{
    if (k > w - m)
        return -INFINITY;
    size_t few = k < m ? k : m, many = k < m ? m : k;
    double sum = 0;
    for (size_t i = 0; i < few; i++)
        sum += log1p(-(double)many / (double)(w - i));
    return sum;
}

double tc_truth_unseen_share(size_t n_all, size_t n, size_t unusable, double confidence)
{
    if (n >= n_all)
        return 0;
    if (unusable >= n)
        return 1;
    size_t w = n_all - unusable, m = n - unusable;
    double limit = log1p(-confidence);
    /* log_missed(k) <= -k m / w, so this k is enough; it is also kept where sums and terms are short. */
    double enough = ceil(-limit * (double)w / (double)m) + 1;
    size_t above = enough < (double)(w - m) ? (size_t)enough : w - m + 1, below = 0; /* log_missed(below) > limit */
    while (above - below > 1) {
        size_t middle = below + (above - below) / 2;
        if (log_missed(w, m, middle) <= limit)
            above = middle;
        else
            below = middle;
    }
    return (double)below / (double)(n_all - n); /* below = K: with K + 1 = above it is improbable */
}
