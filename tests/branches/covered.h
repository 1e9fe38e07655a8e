/* Of the build that counts lines: a process that ends by _exit writes what it counted. */
#include <unistd.h>

#ifdef __cplusplus
extern "C"
#endif
void __gcov_dump(void);

#define _exit(status) (__gcov_dump(), _exit(status))
