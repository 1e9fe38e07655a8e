/* Memory limits of the process's control group. */
#ifndef RETEX_BASE_MACHINE_H
#define RETEX_BASE_MACHINE_H

#include <stdint.h>

/* The lowest memory limit of the process's control group and of those around it; UINT64_MAX where there is none.
 * cgroups: the text of /proc/self/cgroup; root: where control groups are mounted, /sys/fs/cgroup. */
uint64_t retex_machine_cgroup_memory(const char *cgroups, const char *root);

#endif
