/* See head.h. */
#include "head.h"

#include <string.h>
#include <strings.h>

static void refuse(HeadCheck *check, int status, const char *fault)
{
    if (check->status)
        return;
    check->status = status;
    check->fault = fault;
}

static int is_alphanumeric(unsigned char c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/* A word of one or more of these characters besides letters and digits. */
static int is_of(const char *text, const char *others)
{
    const char *c = text;
    while (*c && (is_alphanumeric((unsigned char)*c) || strchr(others, *c)))
        c++;
    return c > text && !*c;
}

static int is_token(const char *text)
{
    return is_of(text, "!#$%&'*+-.^_`|~");
}

static int is_number(const char *text)
{
    return *text && strspn(text, "0123456789") == strlen(text);
}

static int has_control(const char *text)
{
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        if ((*c < 0x20 && *c != '\t') || *c == 0x7f)
            return 1;
    return 0;
}

void head_begin(HeadCheck *check, const char *method, const char *url, const char *url_end, const char *version,
                size_t bytes)
{
    *check = (HeadCheck){.is_old = strcmp(version, "HTTP/1.0") == 0};
    if (!is_token(method))
        refuse(check, 400, "the method is not well formed");
    if (strncmp(version, "HTTP/1.", 7) != 0 || has_control(url) || strpbrk(url, " \t"))
        refuse(check, 400, "the first line is not well formed");
    if (strstr(url, "%00")) /* where a name ends for some programs and not for others */
        refuse(check, 400, "the URL is not well formed: %00 stands for no character");
    if (!bytes)
        return;
    check->at = version + strlen(version) + 2;
    check->end = method + bytes;
    if (url_end != version || check->at > check->end)
        refuse(check, 400, "the first line is not well formed");
}

/* Whether the field is where it must be: `name:`, spaces, the value, CR and LF, of which the divisions are NULs now. */
static int follows(HeadCheck *check, const char *name, const char *value)
{
    const char *begin = name + strlen(name) + 1;
    if (name != check->at || value < begin || value > check->end)
        return 0;
    for (const char *c = begin; c < value; c++)
        if (*c != ' ' && *c != '\t')
            return 0;
    check->at = value + strlen(value) + 2;
    return check->at <= check->end && check->at[-1] == '\0';
}

void head_field(HeadCheck *check, const char *name, const char *value)
{
    value = value ? value : "";
    if (check->at && !check->status && !follows(check, name, value))
        refuse(check, 400, "the header is not well formed: a line is continued, or does not end as it should");
    if (!is_token(name))
        refuse(check, 400, "the name of a header is not well formed");
    if (has_control(value))
        refuse(check, 400, "the value of a header has control characters");
    if (strcasecmp(name, "Host") == 0) {
        check->hosts++;
        if (!is_of(value, "-._~%!$&'()*+,;=:[]"))
            refuse(check, 400, "Host is not well formed");
    } else if (strcasecmp(name, "Content-Length") == 0) {
        check->lengths++;
        if (!is_number(value))
            refuse(check, 400, "Content-Length is no number");
    } else if (strcasecmp(name, "Transfer-Encoding") == 0) {
        check->encodings++;
        if (strcasecmp(value, "chunked") != 0)
            refuse(check, 501, "of Transfer-Encoding only `chunked` is understood");
    }
}

int head_end(HeadCheck *check)
{
    if (check->at && check->at + 2 != check->end)
        refuse(check, 400, "the header is not well formed: its last line does not end as it should");
    if (check->hosts > 1 || (!check->hosts && !check->is_old))
        refuse(check, 400, "expected one header `Host`");
    if (check->lengths > 1)
        refuse(check, 400, "Content-Length is given twice");
    if (check->encodings > 1 || (check->encodings && (check->lengths || check->is_old)))
        refuse(check, 400, "Transfer-Encoding is given twice, beside Content-Length, or in HTTP/1.0");
    return check->status;
}
