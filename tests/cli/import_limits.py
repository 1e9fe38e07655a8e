"""Models of few bytes that say much, for import_limits.t, which also asks for one of these:

  processor COMMAND…   the processor time that it takes, in seconds
  limits COMMAND…      the limits of the process that reads a model, which is then told that its time is over"""
import json
import math
import os
import resource
import signal
import struct
import subprocess
import sys
import time

QUAD = struct.pack('<12f', 0, 0, 0, 3, 0, 0, 3, 0, 3, 0, 0, 3) + struct.pack('<6H', 0, 1, 2, 0, 2, 3)


def write(name, more=b'', **changes):
    model = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
             'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1}]}],
             'buffers': [{'byteLength': len(QUAD + more)}],
             'bufferViews': [{'buffer': 0, 'byteLength': 48}, {'buffer': 0, 'byteOffset': 48, 'byteLength': 12},
                             {'buffer': 0, 'byteOffset': 60, 'byteLength': len(more)}][:3 if more else 2],
             'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3',
                            'min': [0, 0, 0], 'max': [3, 0, 3]},
                           {'bufferView': 1, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}]}
    model.update(changes)
    text = changes.get('text') or json.dumps(model).encode()
    text += b' ' * (-len(text) % 4)
    data = QUAD + more + bytes(-len(QUAD + more) % 4)
    with open(name, 'wb') as out:
        out.write(struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data)) + struct.pack('<I4s', len(text), b'JSON') +
                  text + struct.pack('<I4s', len(data), b'BIN\0') + data)


def accessors(*more):
    return [{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [3, 0, 3]},
            {'bufferView': 1, 'componentType': 5123, 'count': 6, 'type': 'SCALAR'}, *more]


def instances(count):
    """The floor at the place where it is, each turned by another angle, so that no two have the same corners."""
    turns = b''.join(struct.pack('<4f', 0, math.sin(math.pi * i / count), 0, math.cos(math.pi * i / count))
                     for i in range(count))
    return {'more': turns, 'extensionsUsed': ['EXT_mesh_gpu_instancing'],
            'nodes': [{'mesh': 0, 'extensions': {'EXT_mesh_gpu_instancing': {'attributes': {'ROTATION': 2}}}}],
            'accessors': accessors({'bufferView': 2, 'componentType': 5126, 'count': count, 'type': 'VEC4'})}


def within(depth, times):
    """Nodes that each hold the next one so many times."""
    return {'nodes': [{'children': [i + 1] * times} if i < depth else {'mesh': 0} for i in range(depth + 1)]}


def sparse(count, meshes=1):
    values = {'count': 3, 'indices': {'bufferView': 1, 'componentType': 5123}, 'values': {'bufferView': 0}}
    return {'accessors': accessors({'componentType': 5126, 'count': count, 'type': 'VEC3', 'sparse': values}),
            'meshes': [{'primitives': [{'attributes': {'POSITION': 2}, 'indices': 1}]}] * meshes}


def make_models():
    write('one.glb')
    write('some.glb', **instances(200))
    write('turned.glb', **instances(4000))
    write('same.glb', nodes=[{'mesh': 0} for _ in range(4000)], scenes=[{'nodes': list(range(4000))}])
    write('doubled.glb', **within(12, 2))
    write('doubled_more.glb', **within(20, 2))
    write('deep.glb', **within(3999, 1))
    write('deeper.glb', **within(4000, 1))
    write('lists.glb', text=b'{"asset":{"version":"2.0"},"extras":' + b'[' * 100000 + b']' * 100000 + b'}')
    write('sparse.glb', **sparse(4))
    write('sparse_big.glb', **sparse(10**9))
    write('sparse_often.glb', **sparse(10**6, 17))


def processor(command):
    subprocess.run(command, check=True)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(used.ru_utime + used.ru_stime)


def children(pid):
    with open(f'/proc/{pid}/task/{pid}/children', encoding='ascii') as file:
        return [int(child) for child in file.read().split()]


def limits(command):
    tool = subprocess.Popen(command)  # pylint: disable=consider-using-with
    while tool.poll() is None:
        for child in children(tool.pid):
            with open(f'/proc/{child}/limits', encoding='ascii') as file:
                lines = {line[:26].strip(): line[26:].split() for line in file}
            if lines['Max address space'][0] == 'unlimited':
                continue  # it has not limited itself yet
            os.kill(child, signal.SIGSTOP)
            print('seconds', lines['Max cpu time'][0], 'gigabytes', int(lines['Max address space'][0]) >> 30)
            os.kill(child, signal.SIGXCPU)
            os.kill(child, signal.SIGCONT)
            sys.exit(tool.wait())
        time.sleep(.001)
    sys.exit('it was over too soon')


if len(sys.argv) > 1:
    {'processor': processor, 'limits': limits}[sys.argv[1]](sys.argv[2:])
else:
    make_models()
