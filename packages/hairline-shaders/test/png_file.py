"""Pictures as files, for the scripts that make the tests' models."""

import struct
import zlib


def png(size, pixel):
    """A PNG of 8 bits a channel; `pixel` takes the middle of a texel, 0 to 1."""
    rows = b"".join(
        b"\0" + b"".join(bytes(round(255 * c) for c in pixel((x + 0.5) / size, (y + 0.5) / size)) for x in range(size)) for y in range(size)
    )

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
