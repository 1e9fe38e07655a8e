/* Clusters of weighted UVs that merge by Ward's rule. */
#ifndef RENDERER_FILM_CLUSTER_H
#define RENDERER_FILM_CLUSTER_H

/* A weighted distribution of UV. On a periodic axis the mean lies in [0,1), and distances go the short way round. */
typedef struct UvStats {
    double weight;
    double mean[2];
    double m2[3]; /* weighted sums of squared deviations: uu, uv, vv */
} UvStats;

void uv_stats_add(UvStats *stats, double weight, const double uv[2], const int periodic[2]);
void uv_stats_merge(UvStats *into, const UvStats *from, const int periodic[2]);

/* Ward's rule: by how much merging two raises the sum of squared deviations. */
double uv_stats_merge_cost(const UvStats *a, const UvStats *b, const int periodic[2]);

#endif
