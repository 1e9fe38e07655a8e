/* What the player reads: checksums, names, connections that break, compressed streams. */
import { deflateSync } from "node:zlib";
import { fails, random, same, test } from "./tap.mjs";
import { player } from "./player.mjs";

test("CRC-32: the check value of its definition, and long division", () => {
  const { crc32 } = player();
  const bytes = (text) => new TextEncoder().encode(text);
  same(crc32(bytes("123456789")), 0xcbf43926); // the check value of CRC-32/ISO-HDLC
  same(crc32(bytes("")), 0);
  // the remainder of the message, its first 32 bits turned over, by the polynomial 0x104c11db7, bit by bit
  const reversed = (x, bits) => Number.parseInt(x.toString(2).padStart(bits, "0").split("").reverse().join(""), 2);
  const divided = (data) => {
    let register = 0xffffffff;
    for (const byte of data)
      for (let k = 0; k < 8; k++) {
        const out = (register >>> 31) ^ ((byte >> k) & 1);
        register = (register << 1) >>> 0;
        if (out) register = (register ^ 0x04c11db7) >>> 0;
      }
    return reversed((register ^ 0xffffffff) >>> 0, 32);
  };
  const next = random(1);
  for (let k = 0; k < 50; k++) {
    const data = Uint8Array.from({ length: next(0, 60) }, () => next(0, 255));
    same(crc32(data), divided(data));
  }
});

test("pictures that are cut off, lose a byte or have a wrong checksum", () => {
  const { isDamaged, crc32 } = player();
  const text = (word) => [...word].map((letter) => letter.charCodeAt(0));
  const number = (value) => [value >>> 24, (value >>> 16) & 255, (value >>> 8) & 255, value & 255];
  const chunk = (name, data) => [...number(data.length), ...text(name), ...data, ...number(crc32(Uint8Array.from([...text(name), ...data])))];
  const coded = Array.from({ length: 200 }, (_, k) => (k * 37) % 255);
  const files = {
    png: [0x89, ...text("PNG\r\n\x1a\n"), ...chunk("IHDR", [1, 2, 3]), ...chunk("IDAT", coded), ...chunk("IEND", [])],
    // a comment, fill bytes before a marker, a scan with a stuffed byte and a restart
    jpeg: [0xff, 0xd8, 0xff, 0xfe, 0, 4, 65, 66, 0xff, 0xff, 0xda, 0, 3, 1, ...coded, 0xff, 0, ...coded, 0xff, 0xd0, ...coded, 0xff, 0xd9],
    webp: [...text("RIFF"), 208, 0, 0, 0, ...text("WEBP"), ...coded.slice(0, 196), ...text("WEBP"), ...coded.slice(0, 4)],
  };
  for (const [name, whole] of Object.entries(files)) {
    same([name, isDamaged(Uint8Array.from(whole))], [name, false]);
    same([name, isDamaged(Uint8Array.from([...whole, ...coded]))], [name, false]); // cameras and programs add bytes
    for (let tenth = 1; tenth < 10; tenth++)
      same([name, tenth, isDamaged(Uint8Array.from(whole.slice(0, (whole.length * tenth) / 10)))], [name, tenth, true]);
  }
  for (let at = 8; at < files.png.length; at++) {
    const changed = Uint8Array.from(files.png);
    changed[at] ^= 4;
    same([at, isDamaged(changed)], [at, true]);
  }
  same(isDamaged(Uint8Array.from([0xff, 0xd8, 1, ...files.jpeg.slice(2)])), true); // a byte before a marker
  same(isDamaged(Uint8Array.from(text("<svg></svg>"))), false);
  same(isDamaged(new Uint8Array(0)), false);
});

test("names of addresses", () => {
  const { nameOf, wordsOf } = player();
  same(nameOf("https://x.org/a/b%20c.jpg?q=1#there"), "b c.jpg");
  same(nameOf("a/100%.jpg"), "100%.jpg");
  same(nameOf("data:image/png;base64,AAAA/BBBB"), "Picture");
  same(nameOf("blob:https://x.org/1234"), "Picture");
  same(wordsOf("walnut-herring_bone.v2.jpg"), "walnut herring bone.v2");
});

/* A server whose answers are listed, as [status, bytes] or an error; what was asked and how long was waited. */
function server(answers, protocol = "https:") {
  const asked = [], waits = [];
  const world = {
    fetch: async (url, { cache, mode }) => {
      asked.push([String(url), mode || cache]);
      const answer = answers.shift();
      if (answer instanceof Error) throw answer;
      const [status, bytes = []] = answer;
      return { ok: status === 200, status, arrayBuffer: async () => Uint8Array.from(bytes).buffer };
    },
    setTimeout: (action, wait) => (waits.push(wait), action()),
    location: { protocol, origin: "https://x.org", href: "https://x.org/page.html" },
  };
  return { ...player(world), asked, waits };
}
const signal = new AbortController().signal;

test("a busy server and a broken connection are tried again, after .5, 1, 2 and 4 seconds", async () => {
  const s = server([[503], new Error("away"), [500], [502], [200, [1, 2, 3]]]);
  same([...(await s.fetchBytes("https://x.org/a.jpg", signal))], [1, 2, 3]);
  same(s.waits, [500, 1000, 2000, 4000]);
  same(s.asked, Array(5).fill(["https://x.org/a.jpg", "default"]));
});

test("what stays away is told after the fifth time, what is missing at once", async () => {
  let s = server(Array(9).fill([503]));
  await fails(() => s.fetchBytes("https://x.org/a.jpg", signal), "a.jpg is missing (status 503).");
  same(s.asked.length, 5);
  s = server(Array(9).fill(new Error("away")));
  await fails(() => s.fetchBytes("https://x.org/a.jpg", signal), "a.jpg could not be loaded. Is there a connection?");
  same(s.asked.length, 5);
  s = server([[404], [200]]);
  await fails(() => s.fetchBytes("https://x.org/a.jpg", signal), "a.jpg is missing (status 404).");
  same(s.asked.length, 1);
  s = server([new Error("away")], "file:");
  await fails(() => s.fetchBytes("a.jpg", signal), "This page must come from a web server, not from a file.");
});

test("what another site does not let pages read is told at once, by the header that is missing", async () => {
  let s = server([new Error("away"), [0]]);
  await fails(() => s.fetchBytes("https://cdn.org:8/b/a%20b.jpg", signal), "cdn.org:8 answers, but does not let pages of https://x.org read a b.jpg: " +
    "the header Access-Control-Allow-Origin is missing, or names another site.");
  same(s.asked, [["https://cdn.org:8/b/a%20b.jpg", "default"], ["https://cdn.org:8/b/a%20b.jpg", "no-cors"]]);
  s = server([new Error("away"), new Error("away"), [200, [7]]]); // a connection that broke
  same([...(await s.fetchBytes("https://cdn.org/a.jpg", signal))], [7]);
  same(s.waits, [500]);
});

test("what was ended is not tried again", async () => {
  const ended = AbortSignal.abort(), s = server([new Error("ended"), [200]]);
  await fails(() => s.fetchBytes("a.jpg", ended), "ended");
  same(s.asked.length, 1);
});

test("a damaged file is asked for once more, past the caches", async () => {
  const entry = { file: "a.jpg", bytes: 9, crc32: 0xcbf43926 }, good = [...new TextEncoder().encode("123456789")];
  const bad = [...good.slice(0, 4), 0, ...good.slice(5)];
  let s = server([[200, bad], [200, good]]);
  same([...(await s.fetchChecked("https://x.org/room/", entry, signal))], good);
  same(s.asked, [["https://x.org/room/a.jpg", "default"], ["https://x.org/room/a.jpg", "reload"]]);
  s = server([[200, bad], [200, good.slice(1)]]);
  await fails(() => s.fetchChecked("https://x.org/room/", entry, signal), "a.jpg is damaged.");
  s = server([[200, [...good, 0]], [200, bad]]);
  await fails(() => s.fetchChecked("https://x.org/room/", entry, signal), "a.jpg is damaged.");
});

test("streams are inflated up to what a whole file has", async () => {
  const { inflate } = player(), next = random(2);
  const data = Uint8Array.from({ length: 100000 }, () => next(0, 3)), packed = deflateSync(data);
  same(Buffer.compare(Buffer.from(await inflate(packed, "a", data.length + 1)), Buffer.from(data)), 0);
  await fails(() => inflate(packed, "a", data.length), "a is damaged.");
  await fails(() => inflate(packed.subarray(0, packed.length - 9), "a", 1e9), "a is damaged.");
  const broken = Buffer.from(packed);
  broken[50] ^= 255;
  await fails(() => inflate(broken, "a", 1e9), "a is damaged.");
  await fails(() => inflate(deflateSync(Buffer.alloc(1 << 24)), "a", 1 << 20), "a is damaged.");
});
