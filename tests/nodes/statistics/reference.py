#!/usr/bin/env python3
"""Prints the reference values of statistics_test.cpp and rank_sum_test.cpp, by scipy (Debian's python3-scipy)."""
from itertools import product

import numpy as np
from scipy import stats
from scipy.optimize import brentq

few = [0.5, -1.25, 2.0, 3.5, -0.75, 4.25, 1.0, 2.75, -3.0, 5.5]
tied = [1, 1, -1, 2, 2, -2, 3, 3, -4, 5, 5, 5]
many = [((37 * i) % 101 - 40) / 8 for i in range(60)]  # ties, a zero
plain = [12.5, 11.0, 14.25, 9.75, 13.0, 12.0]


def signed_rank_by_all_signs(d):
    ranks = stats.rankdata(np.abs(d))
    sums = np.array([sum(r for r, s in zip(ranks, signs) if s) for signs in product([0, 1], repeat=len(d))])
    least = min(ranks[np.array(d) > 0].sum(), ranks[np.array(d) < 0].sum())
    return least, min(1, 2 * np.mean(sums <= least))


def corrected(p, rule):  # by their definitions
    order = np.argsort(p, kind="stable")
    m = len(p)
    out = np.empty(m)
    if rule == "holm":
        out[order] = np.minimum(1, np.maximum.accumulate([(m - k) * p[i] for k, i in enumerate(order)]))
    else:
        out[order] = np.minimum(1, np.minimum.accumulate([m / (k + 1) * p[i] for k, i in enumerate(order)][::-1])[::-1])
    return out


def student_interval(values, confidence):  # stats.t.ppf is right to nine digits only, its cdf to all
    n = len(values)
    t = brentq(lambda t: stats.t.cdf(t, n - 1) - (1 + confidence) / 2, 0, 100, xtol=1e-15, rtol=1e-15)
    return np.mean(values) - t * stats.sem(values), np.mean(values) + t * stats.sem(values)


show = lambda *values: print(", ".join(f"{v:.17g}" for v in values))
show(*stats.wilcoxon(few, mode="exact"))
show(*stats.wilcoxon([5, 4, -3, 6, 7.5, 8, 9.25, 10], mode="exact"))
show(*signed_rank_by_all_signs(tied))
show(*stats.wilcoxon(many, mode="approx", correction=False, zero_method="wilcox"))
show(*student_interval(plain, 0.95))
show(*student_interval(plain, 0.99))
show(np.mean(plain), np.std(plain, ddof=1))
p = np.array([0.04, 0.001, 0.2, 0.013, 0.013, 0.9])
show(*corrected(p, "holm"))
show(*corrected(p, "bh"))

# rank_sum_test.cpp
untied_a = [0.8, 1.7, 2.9, 3.1, 4.6, 5.2, 7.7]
untied_b = [0.3, 1.1, 1.9, 2.2, 2.4, 3.9]
scores_a = [4, 5, 4, 3, 5, 4, 4, 5]  # opinions: many ties, samples of different sizes
scores_b = [3, 4, 2, 3, 3, 4, 5, 2, 3]
thirds_a = [round((7 * i * i) % 4 / 3, 12) for i in range(50)]  # shares of three clips read right
thirds_b = [round((5 * i + i // 7) % 4 / 3, 12) for i in range(47)]
long_a = [((37 * i) % 101) / 8 for i in range(40)]  # no ties
long_b = [((53 * i) % 97) / 8 + 0.01 for i in range(45)]


def rank_sum_by_all_choices(a, b):  # also by scipy: every permutation, twice the smaller tail
    sum_of_a = lambda x, y, axis: stats.rankdata(np.concatenate([x, y], axis), axis=axis)[..., : x.shape[axis]].sum(axis)
    test = stats.permutation_test((a, b), sum_of_a, vectorized=True, n_resamples=np.inf, batch=5000)
    return test.statistic - len(a) * (len(a) + 1) / 2, test.pvalue


show(*stats.mannwhitneyu(untied_a, untied_b, method="exact"))
show(*stats.mannwhitneyu(untied_a, untied_b, method="asymptotic"))
show(*rank_sum_by_all_choices(scores_a, scores_b))
show(*stats.mannwhitneyu(scores_a, scores_b, method="asymptotic"))
show(*stats.mannwhitneyu(thirds_a, thirds_b, method="asymptotic"))
show(*stats.mannwhitneyu(long_a, long_b, method="exact"))
show(*stats.mannwhitneyu(long_a, long_b, method="asymptotic"))
for part, whole, confidence in [(38, 100, 0.95), (7, 16, 0.99), (0, 12, 0.95), (12, 12, 0.95), (1, 1, 0.9)]:
    show(*stats.binomtest(part, whole).proportion_ci(confidence, "wilson"))
show(2 * np.arcsin(np.sqrt(0.38)) - 2 * np.arcsin(np.sqrt(0.7)))
