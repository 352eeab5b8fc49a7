"""Reading the pictures that tests make."""
import OpenImageIO as oiio


def pixels(path):
    """The colours of an EXR file as floats, height x width x 3. Not by an ImageBuf, which may have the pixels of the picture
    that was there before."""
    picture = oiio.ImageInput.open(path)
    if not picture:
        raise RuntimeError(oiio.geterror())
    try:
        return picture.read_image(0, 0, 0, 3, oiio.FLOAT)
    finally:
        picture.close()
