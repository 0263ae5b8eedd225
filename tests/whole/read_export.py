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


def check_abc():
    """Reads groups and blocks of bytes by the places that they are referred to with."""
    data = open(path, 'rb').read()
    same('the head', data[:8], b'Ogawa\xff\0\1')
    _, faces, corners = obj(folder + '/cloth.obj')
    times = [float(line.split(',')[1]) for line in open(folder + '/frames.csv').read().split()[1:]]

    def group(place):
        n = struct.unpack_from('<Q', data, place)[0]
        return struct.unpack_from('<%dQ' % n, data, place + 8)

    def block(reference):
        place = reference & ~(1 << 63)
        same('the mark of a block', reference >> 63, 1)
        return data[place + 8:place + 8 + struct.unpack_from('<Q', data, place)[0]] if place else b''

    def words(head, at):
        n = struct.unpack_from('<I', head, at)[0]
        return head[at + 4:at + 4 + n].decode(), at + 4 + n

    def properties(place):
        """name: (info, count, words, reference)"""
        *parts, last = group(place)
        head, at, found = block(last), 0, {}
        for part in parts:
            info, at = struct.unpack_from('<I', head, at)[0], at + 4
            count = 0
            if info & 3:
                count, which = struct.unpack_from('<II', head, at)
                same('the times of a property', which, 1)
                at += 8
            name, at = words(head, at)
            meta, at = words(head, at) if info >> 20 else ('', at)
            found[name] = info & ~(0xff << 20), count, meta, part
        same('the end of a head', at, len(head))
        return found

    def samples(entry, form, step):
        info, count, _, part = entry
        stored = [block(reference)[16:] for reference in group(part)[::step]]
        same('the count of frames', count, last + 1 - first)
        same('the count of samples', len(stored), 1 if info & 0x800 else count)
        return [struct.unpack('<%d%s' % (len(one) // struct.calcsize(form), form), one) for one in stored]

    def tuples(flat, n):
        return [tuple(flat[i:i + n]) for i in range(0, len(flat), n)]

    version, library, top, meta, timing, shared = group(struct.unpack_from('<Q', data, 8)[0])
    same('the versions', [struct.unpack('<I', block(one))[0] for one in (version, library)], [0, 10500])
    same('the rate', b'_ai_DCC_FPS=25' in block(meta), True)
    same('the shared words', block(shared), b'')
    timing = block(timing)
    same('the first times', struct.unpack_from('<IdId', timing), (last + 1 - first, 1, 1, 0))
    count, period, n = struct.unpack_from('<IdI', timing, 24)
    same('the counts of times', (count, period, n), (last + 1 - first, sys.float_info.max / 32, last + 1 - first))
    same('the times', list(struct.unpack_from('<%dd' % n, timing, 40)), times[first:last + 1])
    none, *objects, names = group(top)
    names, at, meshes = block(names), 0, {}
    for place in objects:
        name, at = words(names, at)
        same('the mark of a mesh', names[at], 255)
        meta, at = words(names, at + 1)
        same('the schema', 'schemaObjTitle=AbcGeom_PolyMesh_v1:.geom' in meta, True)
        meshes[name] = properties(properties(group(place)[0])['.geom'][3])
    same('the list of meshes', list(meshes), ['cloth_0', 'cloth_1', 'obstacles'])
    same('the end of the names', (none, at), (0, len(names) - 32))
    begin = 0
    for name, mesh in meshes.items():
        points = [tuples(one, 3) for one in samples(mesh['P'], 'f', 2)]
        same('the kind of points', mesh['P'][:1] + mesh['P'][2:3],
             ((0x35aa if len(points) > 1 else 0x3daa), 'geoScope=vtx;interpretation=point'))
        for k, box in enumerate(samples(mesh['.selfBnds'], 'd', 1)):
            same('a box', tuples(box, 3), [tuple(f(p[c] for p in points[k]) for c in range(3)) for f in (min, max)])
        counts, = samples(mesh['.faceCounts'], 'i', 2)
        index, = samples(mesh['.faceIndices'], 'i', 2)
        if name == 'obstacles':
            same('the triangles', (set(counts), min(index), max(index)), ({3}, 0, len(points[0]) - 1))
            for k, one in enumerate(points):
                check_ball(one, first + k)
            continue
        for k, one in enumerate(points):
            same('frame %d of %s' % (first + k, name), one, folder_frame(first + k)[begin:begin + len(one)])
        mine = [i for i, face in enumerate(faces) if begin <= face[0] < begin + len(points[0])]
        same('the counts of ' + name, list(counts), [len(faces[i]) for i in mine])
        same('the faces of ' + name, list(index), [v - begin for i in mine for v in reversed(faces[i])])
        uv = properties(mesh['uv'][3])
        values, numbers = tuples(samples(uv['.vals'], 'f', 2)[0], 2), samples(uv['.indices'], 'I', 2)[0]
        wanted = [pair for i in mine for pair in reversed(corners[i])]
        if len(numbers) != len(wanted) or any(abs(a - b) > 1e-6 for n, p in zip(numbers, wanted) for a, b in zip(values[n], p)):
            sys.exit('uv of %s differ' % name)
        begin += len(points[0])


{'abc': check_abc, 'usda': check_usd, 'usd': check_usd, 'glb': check_gltf, 'obj': check_obj}[path.rsplit('.')[-1]]()
