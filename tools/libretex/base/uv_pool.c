/* Clusters of UV, merged by cheapest pair. See uv_pool.h. */
#include "base/uv_pool.h"
#include <retex/host/assert.h>


static double merging_cost(const RetexUvPool *pool, int i, int j)
{
    return pool->sharp ? retex_uv_stats_ward(&pool->of[i].place, &pool->of[j].place, pool->periodic)
                       : retex_uv_stats_variation_gain(&pool->of[i].place, &pool->of[j].place, pool->periodic);
}

static void find_costs(RetexUvPool *pool, int i)
{
    for (int j = 0; j < pool->count; j++)
        if (j != i)
            pool->cost[j < i ? i : j][j < i ? j : i] = merging_cost(pool, i, j);
}

void retex_uv_pool_remove(RetexUvPool *pool, int j)
{
    const int last = --pool->count;
    RETEX_ASSERT(j >= 0 && j <= last);
    if (j == last)
        return;
    pool->of[j] = pool->of[last];
    for (int k = 0; k < last; k++)
        if (k != j)
            pool->cost[k < j ? j : k][k < j ? k : j] = pool->cost[last][k];
}

void retex_uv_pool_merge(RetexUvPool *pool, int i, int j)
{
    RETEX_ASSERT(i < j); /* so i stays where it is when the last one takes the place of j */
    retex_uv_stats_merge(&pool->of[i].place, &pool->of[j].place, pool->periodic);
    pool->merged(pool->context, pool->of[i].number, pool->of[j].number);
    retex_uv_pool_remove(pool, j);
    find_costs(pool, i);
}

void retex_uv_pool_merge_cheapest(RetexUvPool *pool)
{
    int first = 1, second = 0;
    for (int i = 1; i < pool->count; i++)
        for (int j = 0; j < i; j++)
            if (pool->cost[i][j] < pool->cost[first][second])
                first = i, second = j;
    retex_uv_pool_merge(pool, second, first);
}

void retex_uv_pool_add(RetexUvPool *pool, const RetexUvStats *place, int number)
{
    RETEX_ASSERT(pool->count <= RETEX_UV_POOL); /* there is room for one more, until two have merged */
    pool->of[pool->count++] = (RetexUvCluster){*place, number};
    find_costs(pool, pool->count - 1);
    if (pool->count > RETEX_UV_POOL)
        retex_uv_pool_merge_cheapest(pool);
}

void retex_uv_pool_sort(RetexUvPool *pool)
{
    for (int i = 1; i < pool->count; i++)
        for (int j = i; j > 0; j--) {
            RetexUvCluster *a = &pool->of[j - 1], *b = &pool->of[j], swapped = *a;
            if (a->place.mean[0] + a->place.mean[1] <= b->place.mean[0] + b->place.mean[1])
                break;
            *a = *b, *b = swapped;
        }
}
