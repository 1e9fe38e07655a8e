/* What libraries leave of the processor's state. */
#ifndef RETEX_CPU_H
#define RETEX_CPU_H

/* To be called behind a library that may leave the upper halves of vector registers in use. ISA-L's functions for AVX
 * do. Until they are cleared, Intel's processors lose dozens of cycles where code of the baseline and code for AVX
 * alternate, as in each call of pow: see Intel 64 and IA-32 Architectures Optimization Reference Manual, "Mixing AVX
 * Code with SSE Code". */
void retex_cpu_clear_upper_halves(void);

#endif
