/* Who asks retex-serve, and how: addresses, proxies that are trusted, limits of one client, connections that are too
 * slow, and heads of requests. */
#include "lib_test.h"
#include <cmocka.h>

#include <netinet/in.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <retex/clock.h>

#include "serve/clients/address.h"
#include "serve/clients/clients.h"
#include "http/head.h"
#include "serve/clients/peers.h"

/* ---- addresses ---- */

static Address address(const char *text)
{
    Address parsed;
    assert_int_equal(address_parse(&parsed, text), 0);
    return parsed;
}

static void test_addresses(void **state)
{
    char text[ADDRESS_TEXT];
    Address a = address("192.0.2.7"), b = address("::ffff:192.0.2.7");
    struct sockaddr_in four = {.sin_family = AF_INET, .sin_addr = {htonl(0xc0000207)}};
    (void)state;
    assert_true(address_is_same(&a, &b));
    assert_string_equal(address_text(&b, text), "192.0.2.7");
    assert_int_equal(address_of_socket(&b, (struct sockaddr *)&four), 0);
    assert_true(address_is_same(&a, &b));
    four.sin_family = AF_UNIX;
    assert_int_equal(address_of_socket(&b, (struct sockaddr *)&four), -1);
    assert_int_equal(address_of_socket(&b, NULL), -1);
    a = address("2001:db8::1");
    assert_string_equal(address_text(&a, text), "2001:db8::1");
    assert_int_equal(address_parse(&a, "192.0.2"), -1);
    assert_int_equal(address_parse(&a, ""), -1);
    /* one client is an address of IPv4, but a network of 64 bits of IPv6 */
    a = address("2001:db8:0:1:2:3:4:5"), b = address("2001:db8:0:1:ffff::");
    a = address_of_client(&a), b = address_of_client(&b);
    assert_true(address_is_same(&a, &b));
    b = address("2001:db8:0:2::"), b = address_of_client(&b);
    assert_false(address_is_same(&a, &b));
    a = address("192.0.2.1"), b = address("192.0.2.2");
    a = address_of_client(&a), b = address_of_client(&b);
    assert_false(address_is_same(&a, &b));
}

static void test_trusted(void **state)
{
    static const char *const wrong[] = {"", "a", "1.2.3.4/33", "1.2.3.4/-1", "1.2.3.4/", "1.2.3.4/8x", "::1/129",
                                        "1.2.3.4/+8", "1.2.3.4 ", "example.org"};
    static const struct {
        const char *address;
        int is_trusted;
    } rows[] = {{"127.0.0.1", 1},   {"127.0.0.2", 0},     {"10.255.0.1", 1},        {"11.0.0.1", 0},
                {"172.31.9.9", 1},  {"172.32.0.0", 0},    {"fd12::1", 1},           {"fe80::1", 0},
                {"::1", 1},         {"::2", 0},           {"::ffff:127.0.0.1", 1}};
    Trusted trusted = {.count = 0};
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        assert_int_equal(trusted_add(&trusted, wrong[i]), -1);
    assert_int_equal(trusted_add(&trusted, "127.0.0.1"), 0);
    assert_int_equal(trusted_add(&trusted, "10.0.0.0/8"), 0);
    assert_int_equal(trusted_add(&trusted, "172.16.0.0/12"), 0);
    assert_int_equal(trusted_add(&trusted, "fd00::/8"), 0);
    assert_int_equal(trusted_add(&trusted, "::1"), 0);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const Address a = address(rows[i].address);
        assert_int_equal(trusted_has(&trusted, &a), rows[i].is_trusted);
    }
    while (trusted.count < TRUSTED_MAX)
        assert_int_equal(trusted_add(&trusted, "::1"), 0);
    assert_int_equal(trusted_add(&trusted, "::1"), -1);
}

static void test_forwarded(void **state)
{
    static const struct {
        const char *list, *client; /* NULL: none */
    } rows[] = {{"192.0.2.1", "192.0.2.1"},
                {"192.0.2.9, 192.0.2.1", "192.0.2.1"},
                {"192.0.2.1 ,\t10.1.2.3,127.0.0.1 ", "192.0.2.1"},
                {"nonsense, 192.0.2.1:4711", "192.0.2.1"},
                {"[2001:db8::1]:443", "2001:db8::1"},
                {"2001:db8::1", "2001:db8::1"},
                {"[2001:db8::1]", "2001:db8::1"},
                {"192.0.2.1, nonsense", "::"},
                {"192.0.2.1, nonsense, 127.0.0.1", "::"},
                {"unknown", "::"},
                {"fe80::1%eth0", "::"},
                {"\"192.0.2.1\"", "::"},
                {"10.0.0.1", NULL},
                {",", "::"},
                {" ", "::"},
                {"", "::"},
                {NULL, NULL}};
    Trusted trusted = {.count = 0};
    Address client;
    (void)state;
    trusted_add(&trusted, "127.0.0.1");
    trusted_add(&trusted, "10.0.0.0/8");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(trusted_client(&trusted, rows[i].list, &client), rows[i].client ? 0 : -1);
        if (rows[i].client) {
            const Address wanted = address(rows[i].client);
            assert_true(address_is_same(&client, &wanted));
        }
    }
    char *list = malloc(60000);
    memset(list, '1', 59999);
    list[59999] = '\0';
    assert_int_equal(trusted_client(&trusted, list, &client), 0);
    const Address unknown = address("::");
    assert_true(address_is_same(&client, &unknown));
    free(list);
}

/* ---- limits ---- */

static void test_peers(void **state)
{
    const Address a = address("192.0.2.1"), b = address("192.0.2.2");
    Peer *of_a[16], *of_b;
    Peers *peers = peers_open(16);
    (void)state;
    for (int i = 0; i < 16; i++) {
        assert_true(peers_has_place(peers, &a));
        assert_non_null(of_a[i] = peers_enter(peers, &a));
    }
    assert_false(peers_has_place(peers, &a));
    assert_null(peers_enter(peers, &a));
    assert_non_null(of_b = peers_enter(peers, &b));
    assert_true(peers_begin_upload(peers, of_a[0]) && peers_begin_upload(peers, of_a[1]));
    assert_false(peers_begin_upload(peers, of_a[2])); /* an eighth */
    assert_true(peers_begin_upload(peers, of_b));
    peers_end_upload(of_b);
    peers_end_upload(of_a[0]);
    assert_true(peers_begin_upload(peers, of_a[2]));
    peers_leave(peers, of_a[3]);
    assert_true(peers_has_place(peers, &a));
    for (int i = 4; i < 16; i++)
        peers_leave(peers, of_a[i]);
    peers_leave(peers, NULL);
    peers_close(peers); /* with what is still there */
    peers = peers_open(0);
    for (int i = 0; i < 1000; i++) {
        Peer *peer = peers_enter(peers, &a);
        assert_true(peer && peers_begin_upload(peers, peer));
    }
    peers_close(peers);
    peers = peers_open(1); /* one upload, too */
    of_b = peers_enter(peers, &b);
    assert_true(peers_begin_upload(peers, of_b));
    assert_false(peers_begin_upload(peers, of_b));
    peers_leave(peers, of_b);
    peers_close(peers);
    peers_close(NULL);
}

/* A connection of which the other end is `seen`: whether it was shut down. */
static int is_cut(int seen)
{
    char byte;
    return recv(seen, &byte, 1, MSG_DONTWAIT) == 0;
}

static void test_slow_clients(void **state)
{
    enum { SENDS, WAITS, CRAWLS, FAST, LEFT, ASKS, COUNT };
    int pairs[COUNT][2];
    Client *each[COUNT];
    Clients *clients = clients_open();
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, pairs[i]), 0);
        each[i] = clients_add(clients, pairs[i][0]);
        assert_int_equal(clients_count(clients), i + 1);
    }
    clients_set(clients, each[WAITS], CLIENT_WAITS);
    clients_set(clients, each[CRAWLS], CLIENT_UPLOADS);
    clients_set(clients, each[FAST], CLIENT_UPLOADS);
    const double began = retex_clock_seconds();
    clients_received(clients, each[CRAWLS], 9000);
    clients_received(clients, each[FAST], 10100);
    /* LEFT has ended what it sends; ASKS too, but has asked for something before */
    assert_int_equal(send(pairs[ASKS][1], "x", 1, 0), 1);
    shutdown(pairs[ASKS][1], SHUT_WR);
    clients_sweep(clients, began + 9, 30, 1000);
    for (int i = 0; i < COUNT; i++)
        assert_false(is_cut(pairs[i][1]));
    shutdown(pairs[LEFT][1], SHUT_WR);
    clients_sweep(clients, began + 9.1, 30, 1000); /* is looked at a few times a second */
    assert_false(is_cut(pairs[LEFT][1]));
    clients_sweep(clients, began + 9.9, 30, 1000);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(is_cut(pairs[i][1]), i == LEFT);
    clients_sweep(clients, began + 10.05, 30, 1000);
    assert_true(is_cut(pairs[CRAWLS][1]) && !is_cut(pairs[FAST][1]) && !is_cut(pairs[SENDS][1]));
    clients_received(clients, each[FAST], 9900); /* what came before does not count again */
    clients_sweep(clients, began + 20, 30, 1000);
    assert_false(is_cut(pairs[FAST][1]));
    clients_sweep(clients, began + 20.1, 30, 1000);
    assert_true(is_cut(pairs[FAST][1]) && !is_cut(pairs[SENDS][1]));
    clients_sweep(clients, began + 31, 30, 1000);
    assert_true(is_cut(pairs[SENDS][1]) && !is_cut(pairs[WAITS][1]));
    assert_int_equal(clients_count(clients), COUNT); /* those that are cut are removed where they are noticed */
    clients_remove(clients, each[ASKS]);
    clients_remove(clients, each[SENDS]);
    assert_int_equal(clients_count(clients), COUNT - 2);
    clients_close(clients);
    for (int i = 0; i < COUNT; i++)
        close(pairs[i][0]), close(pairs[i][1]);
}

/* ---- heads of requests ---- */

/* The status of a head as libmicrohttpd leaves it: a NUL for each space of the first line, the colon and both bytes of
 * each line's end. Fields that are told begin at the strings of `names`, and values at the next string that is not
 * empty. */
static int status_of(const char *head, size_t bytes, int is_kept, const char *const names[])
{
    const char *url = head + strlen(head) + 1, *version = url + strlen(url) + 1;
    HeadCheck check;
    head_begin(&check, head, url, version, version, is_kept ? bytes : 0);
    for (const char *at = head, *const *name = names; *name; name++) {
        while (strcmp(at, *name) != 0)
            at++;
        const char *value = at + strlen(at) + 1;
        value += strspn(value, " \t");
        head_field(&check, at, value);
        at = value;
    }
    return head_end(&check);
}

#define STATUS(head, is_kept, ...) status_of(head, sizeof(head) - 1, is_kept, (const char *const[]){__VA_ARGS__, NULL})
#define FIRST "GET\0/v1\0HTTP/1.1\0\0"

static void test_heads(void **state)
{
    (void)state;
    for (int kept = 0; kept < 2; kept++) {
        assert_int_equal(STATUS(FIRST "Host\0 x\0\0\0\0", kept, "Host"), 0);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0A\0\t \0\0B\0\0\0\0\0", kept, "Host", "A", "B"), 0);
        assert_int_equal(STATUS(FIRST "A\0x\0\0\0\0", kept, "A"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0HOST\0x\0\0\0\0", kept, "Host", "HOST"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x y\0\0\0\0", kept, "Host"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0A b\0y\0\0\0\0", kept, "Host", "A b"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0A\0y\rB: z\0\0\0\0", kept, "Host", "A"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0Content-Length\0 7\0\0\0\0", kept, "Host", "Content-Length"), 0);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0Content-Length\0+7\0\0\0\0", kept, "Host", "Content-Length"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0Content-Length\0" "7\0\0content-length\0" "7\0\0\0\0", kept, "Host",
                                "Content-Length", "content-length"), 400);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0Transfer-Encoding\0 Chunked\0\0\0\0", kept, "Host",
                                "Transfer-Encoding"), 0);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0Transfer-Encoding\0chunked \0\0\0\0", kept, "Host",
                                "Transfer-Encoding"), 501);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0Transfer-Encoding\0chunked\0\0content-length\0" "7\0\0\0\0", kept,
                                "Host", "Transfer-Encoding", "content-length"), 400);
        assert_int_equal(STATUS("GET\0/v1\0HTTP/1.0\0\0A\0y\0\0\0\0", kept, "A"), 0);
        assert_int_equal(STATUS("GET\0/v1\0HTTP/2.0\0\0Host\0x\0\0\0\0", kept, "Host"), 400);
        assert_int_equal(STATUS("G(T\0/v1\0HTTP/1.1\0\0Host\0x\0\0\0\0", kept, "Host"), 400);
        assert_int_equal(STATUS("GET\0/v1 x\0HTTP/1.1\0\0Host\0x\0\0\0\0", kept, "Host"), 400);
        /* what only the layout shows: a line that is continued, one that ends with LF alone, a NUL */
        const int hidden = kept ? 400 : 0;
        assert_int_equal(STATUS(FIRST "Host\0x\0\0A\0y\0\0 Content-Length: 7\0\0\0\0", kept, "Host", "A"), hidden);
        assert_int_equal(STATUS(FIRST "Host\0x\0A\0y\0\0\0\0", kept, "Host", "A"), hidden);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0A\0y\0z\0\0\0\0", kept, "Host", "A"), hidden);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0A\0y\0z\0\0B\0z\0\0\0\0", kept, "Host", "A", "B"), hidden);
        assert_int_equal(STATUS(FIRST "Host\0x\0\0\0Content-Length: 7\0\0\0\0", kept, "Host"), hidden);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_addresses), cmocka_unit_test(test_trusted),      cmocka_unit_test(test_forwarded),
        cmocka_unit_test(test_peers),     cmocka_unit_test(test_slow_clients), cmocka_unit_test(test_heads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
