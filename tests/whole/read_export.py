"""Compares a file of duite-view --export with the folder that it was made of: read_export.py FOLDER FILE FIRST:LAST"""
import json, re, struct, sys

folder, path, frames = sys.argv[1:]
first, last = map(int, frames.split(':'))


def folder_frame(k):
    data = open(folder + '/cloth.pc2', 'rb').read()
    n = struct.unpack('<12sii', data[:20])[2]
    flat = struct.unpack('<%df' % (3 * n), data[32 + 12 * n * k:32 + 12 * n * (k + 1)])
    return [tuple(flat[i:i + 3]) for i in range(0, 3 * n, 3)]


def as_floats(text):
    return [tuple(struct.unpack('<3f', struct.pack('<3f', *map(float, point.split(',')))))
            for point in re.findall(r'\(([^()]*)\)', text)]


def obj(name):
    points, faces, uv, corners = [], [], [], []
    for line in open(name):
        word = line.split()
        if word[:1] == ['v']:
            points.append(tuple(map(float, word[1:4])))
        elif word[:1] == ['vt']:
            uv.append(tuple(map(float, word[1:3])))
        elif word[:1] == ['f']:
            faces.append([int(corner.split('/')[0]) - 1 for corner in word[1:]])
            corners.append([uv[int(corner.split('/')[1]) - 1] for corner in word[1:]])
    return points, faces, corners


def same(what, is_, should):
    if is_ != should:
        sys.exit('%s differs: %s, not %s' % (what, str(is_)[:200], str(should)[:200]))


def check_ball(points, k):
    middle = [sum(p[c] for p in points) / len(points) for c in range(3)]
    if abs(middle[0] - 0.04 * k) > 1e-3 or abs(middle[1] + 1) > 1e-3:
        sys.exit('the ball of frame %d is at %s' % (k, middle))


def whole_numbers(text, name):
    return list(map(int, re.search(name + r' = \[([^]]*)\]', text)[1].split(',')))


def check_usd():
    text = open(path).read()
    _, faces, corners = obj(folder + '/cloth.obj')
    meshes = dict(re.findall(r'def Mesh "(\w+)"\n(.*?)\n    }', text, re.S))
    same('the list of meshes', list(meshes), ['cloth_0', 'cloth_1', 'obstacles'])
    same('the rate', re.search(r'timeCodesPerSecond = (\S+)', text)[1], '25')
    same('the begin', int(re.search(r'startTimeCode = (\S+)', text)[1]), first)
    same('the end', int(re.search(r'endTimeCode = (\S+)', text)[1]), last)
    begin = 0
    for name in 'cloth_0', 'cloth_1':
        samples = dict((int(k), as_floats(points)) for k, points in
                       re.findall(r'(\d+): \[([^]]*)\]', meshes[name].split('timeSamples')[1]))
        same('the frames of ' + name, sorted(samples), list(range(first, last + 1)))
        n = len(samples[first])
        for k in samples:
            same('frame %d of %s' % (k, name), samples[k], folder_frame(k)[begin:begin + n])
        mine = [i for i, face in enumerate(faces) if begin <= face[0] < begin + n]
        same('the counts of ' + name, whole_numbers(meshes[name], 'faceVertexCounts'), [len(faces[i]) for i in mine])
        same('the faces of ' + name, whole_numbers(meshes[name], 'faceVertexIndices'),
             [v - begin for i in mine for v in faces[i]])
        uv = re.search(r'primvars:st = \[([^]]*)\]', meshes[name])[1]
        uv = [tuple(map(float, pair.split(','))) for pair in re.findall(r'\(([^()]*)\)', uv)]
        wanted = [pair for i in mine for pair in corners[i]]
        if len(uv) != len(wanted) or any(abs(a - b) > 1e-8 for p, q in zip(uv, wanted) for a, b in zip(p, q)):
            sys.exit('uv of %s differ' % name)
        begin += n
    for k, points in re.findall(r'(\d+): \[([^]]*)\]', meshes['obstacles'].split('timeSamples')[1]):
        check_ball(as_floats(points), int(k))


def check_gltf():
    data = open(path, 'rb').read()
    magic, version, size, n, kind = struct.unpack('<5I', data[:20])
    same('the head', (magic, version, size, kind), (0x46546C67, 2, len(data), 0x4E4F534A))
    same('the second chunk', struct.unpack('<2I', data[20 + n:28 + n]), (len(data) - 28 - n, 0x004E4942))
    head, buffer = json.loads(data[20:20 + n]), data[28 + n:]
    same('the buffer', head['buffers'][0]['byteLength'], len(buffer))

    def part(number):
        accessor = head['accessors'][number]
        view = head['bufferViews'][accessor['bufferView']]
        width = {'VEC3': 3, 'VEC2': 2, 'SCALAR': 1}[accessor['type']]
        count = accessor['count'] * width
        same('the length of part %d' % number, view['byteLength'], 4 * count)
        flat = struct.unpack_from('<%d%s' % (count, 'f' if accessor['componentType'] == 5126 else 'I'), buffer, view['byteOffset'])
        return [flat[i:i + width] for i in range(0, count, width)]

    cloth, ball = [mesh['primitives'][0] for mesh in head['meshes']]
    points = part(cloth['attributes']['POSITION'])
    same('the cloth', points, folder_frame(first))
    box = head['accessors'][cloth['attributes']['POSITION']]
    same('the box', [struct.unpack('<3f', struct.pack('<3f', *box[end])) for end in ('min', 'max')],
         [tuple(f(p[c] for p in points) for c in range(3)) for f in (min, max)])
    _, faces, corners = obj(folder + '/cloth.obj')
    index = [i for i, in part(cloth['indices'])]
    same('the triangles', index, [v for face in faces for v in face])
    uv = part(cloth['attributes']['TEXCOORD_0'])
    if any(abs(uv[i][0] - u) + abs(1 - uv[i][1] - v) > 1e-6 for i, (u, v) in zip(index, (c for f in corners for c in f))):
        sys.exit('uv differ')
    check_ball(part(ball['attributes']['POSITION']), first)


def check_obj():
    points, faces, corners = obj(path)
    same('the points', points, folder_frame(first))
    same('the faces', (faces, corners), obj(folder + '/cloth.obj')[1:])


{'usda': check_usd, 'usd': check_usd, 'glb': check_gltf, 'obj': check_obj}[path.rsplit('.')[-1]]()
