/* Clusters of UV of several pixels, merged by cheapest pair. Private to libretex. */
#ifndef RETEX_BASE_UV_POOL_H
#define RETEX_BASE_UV_POOL_H

#include <retex/host/uv_stats.h>

#define RETEX_UV_POOL 12 /* most clusters while they are gathered */

typedef struct RetexUvCluster {
    RetexUvStats place;
    int number; /* the caller's, of the clusters that were added: of one of those that it is merged of */
} RetexUvCluster;

/* Begin with periodic, sharp, merged and context, all else 0. */
typedef struct RetexUvPool {
    const int *periodic; /* of the target */
    int sharp;           /* 1: merging costs what it does to points that are seen sharply (retex_uv_stats_ward) */
    void (*merged)(void *context, int into, int from); /* told the numbers of clusters that are merged */
    void *context;
    int count;
    RetexUvCluster of[RETEX_UV_POOL + 1];
    double cost[RETEX_UV_POOL + 1][RETEX_UV_POOL + 1]; /* of merging clusters i and j < i */
} RetexUvPool;

/* Add a cluster; if there are too many then, the cheapest pair is merged. */
void retex_uv_pool_add(RetexUvPool *pool, const RetexUvStats *place, int number);
/* Remove cluster j; the last cluster takes its index. */
void retex_uv_pool_remove(RetexUvPool *pool, int j);
/* Merge cluster j into cluster i < j, and remove it. */
void retex_uv_pool_merge(RetexUvPool *pool, int i, int j);
void retex_uv_pool_merge_cheapest(RetexUvPool *pool); /* of at least two */
/* Sort by place, so that clusters of neighbours that are alike have the same index. Costs are no longer known. */
void retex_uv_pool_sort(RetexUvPool *pool);

#endif
