/* Textures laid on a set: what they show at the footprints of their targets is part of the set then. It is the first
 * half of a retexture; the second, recombination, needs no texture any more. */
#ifndef RETEX_LAID_H
#define RETEX_LAID_H

#include <retex/access.h>
#include <retex/set.h>
#include <retex/texture.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Lay textures on a set: filter them at every footprint of their targets. specs[0..nspecs) name their targets; a target
 * named twice is an error, one that is not named stays as it is, one that has a texture gets the new one. Where a
 * texture is transparent the footprint's original albedo shows through. Output is the same to the bit for every
 * nthreads. The set is in memory. After a failure the named targets have their originals. */
int retex_sample(RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads, RetexError *err);

/* As retex_sample, with textures that were loaded already, by target, of these specs (see retex_textures_load); of a
 * set that may be open, and with little of it in memory: parts as large as the picture go band by band into a band
 * store in the folder of `near`, the file that they are for; "-" is standard output. */
int retex_sample_textures(RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS], const RetexTextureSpec *specs,
                          int nspecs, const char *near, int nthreads, RetexError *err);

/* Lay on a set what is laid on another, or what is in a file of samples: parts move, in place of those of the same
 * targets. Both have the same size, targets and footprints, and are of one render, else RETEX_EINVAL. What is left of
 * `from` is still the caller's to close. */
int retex_set_lay(RetexSet *set, RetexSet *from, RetexError *err);
/* Take the texture off a target, which has its original again; -1: off all. */
void retex_set_lift(RetexSet *set, int target);
/* 1: a texture is laid on some target. */
int retex_set_has_laid(const RetexSet *set);

/* Let a set name the file that it was read from or opened in, which is a regular one: retex_set_write_samples then
 * writes its absolute path, its size and the checksum of its manifest, which has those of all parts. path NULL: name
 * none. */
int retex_set_refer(RetexSet *set, const char *path, RetexError *err);
/* The path of the file that a set, or samples, name; "" = none. It belongs to the set. */
const char *retex_set_reference(const RetexSet *set);
/* Samples that name their set become that set with them laid on, opened as retex_set_open does. Whoever made the
 * samples chose the path: access says which files may be read. RETEX_EFORMAT where the file has another size or
 * checksum than the set that the samples were made for. After a failure *samples is as it was. */
int retex_set_open_referred(RetexSet **samples, const RetexAccess *access /* NULL = any */, int nthreads,
                            RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
