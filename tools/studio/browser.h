/* Opens the page in the user's browser. */
#ifndef RETEX_STUDIO_BROWSER_H
#define RETEX_STUDIO_BROWSER_H

/* Open an address, which ends with a newline, where there is a display. Others of this machine can see the words of
 * every program: so the browser gets a file that only the user can read, which leads to the address. *file is its name,
 * or NULL. */
void browser_open(const char *address, char **file);
void browser_close(char **file);

#endif
