# What serve_hints.t asks of retex-serve: the size `auto`, by client hints.
import sys

sys.dont_write_bytecode = True
from serve_ask import ask, expect, metric, run

NAMES = {'Accept', 'Sec-CH-Width', 'Sec-CH-Viewport-Width', 'Sec-CH-DPR', 'Width', 'Viewport-Width', 'DPR'}


def widths(server):
    """The picture is that of the width that is meant, and never larger than the room."""
    # a hint of up to 320 means 320 pixels, up to 480 means 480, and beyond that all 500: `full`
    for headers, size in (({'Sec_CH_Width': '100'}, '320x'), ({'Width': '321'}, '480x'), ({'Sec_CH_Width': '100', 'Width': '400'}, '320x'),
                          ({'Sec_CH_Viewport_Width': '200', 'Sec_CH_DPR': '2'}, '480x'), ({'Viewport_Width': '200', 'DPR': '1.0'}, '320x'),
                          ({'Sec_CH_Width': '481'}, 'full'), ({'Sec_CH_Width': '99999'}, 'full'), ({}, 'full'),
                          ({'Sec_CH_Width': 'wide'}, 'full'), ({'Sec_CH_DPR': '2'}, 'full')):
        got, wanted = ask(server, '/v1/room/auto.png', **headers), ask(server, f'/v1/room/{size}.png')
        expect(headers, (got.status, got.body == wanted.body), (200, True))
    # of a part as well, which has its own width
    for crop, size in ('0,0,400,100', '320x'), ('0,0,200,100', 'full'):
        part, wanted = ask(server, f'/v1/room/auto.png?crop={crop}', Sec_CH_Width='300'), ask(server, f'/v1/room/{size}.png?crop={crop}')
        expect(crop, (part.status, part.body == wanted.body), (200, True))


def headers(server):
    """The answer says by what it differs, and is for the browser alone."""
    answer = ask(server, '/v1/room/auto', Accept='image/png', Sec_CH_Width='100')
    listed = lambda name: {part.strip() for value in answer.headers.get_all(name) for part in value.split(',')}
    expect('Vary', listed('Vary'), NAMES)
    expect('Accept-CH', listed('Accept-CH'), NAMES - {'Accept'})
    expect('cache', answer.getheader('Cache-Control'), 'private, max-age=60')
    tag = answer.getheader('ETag')
    expect('tags', len({tag, ask(server, '/v1/room/auto', Accept='image/png', Sec_CH_Width='400').getheader('ETag'),
                        ask(server, '/v1/room/auto', Accept='image/png').getheader('ETag')}), 3)
    same = ask(server, '/v1/room/auto', Accept='image/png', Sec_CH_Width='300', If_None_Match=tag)
    expect('unchanged', (same.status, same.getheader('Accept-CH') is not None), (304, True))
    for path in '/v1/room/full.png', '/v1/room/320x.png', '/v1/room/thumbnail.png':
        other = ask(server, path, Sec_CH_Width='100')
        expect(path, (other.getheader('Accept-CH'), other.getheader('Vary'), other.getheader('Cache-Control')),
               (None, None, 'public, max-age=60'))


def bounded(server):
    """Whatever clients tell, few pictures are made."""
    for width in range(1, 600, 3):
        ask(server, '/v1/room/auto.jpg', Sec_CH_Width=str(width), Sec_CH_DPR=f'{1 + width / 600:.3f}')
    expect('kept', metric(server, 'pictures_kept'), 3)  # 320, 480 and full


run(globals(), {})
