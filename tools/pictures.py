"""Reading pictures, for the scripts here that measure them. Needs numpy and OpenImageIO (tools/install-deps test)."""
import sys

import numpy
import OpenImageIO as oiio


def read(path):
    """All channels of a picture: an array of rows, columns and channels, in double precision."""
    # Not by ImageBuf, which remembers files by their names.
    picture = oiio.ImageInput.open(path)
    if picture is None:
        sys.exit("cannot read %s: %s" % (path, oiio.geterror()))
    pixels = numpy.array(picture.read_image(oiio.FLOAT), dtype=float)
    picture.close()
    return pixels
