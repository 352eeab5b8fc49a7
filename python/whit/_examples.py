"""A scene for the examples in docstrings."""

SPHERE = """
Film "image" "integer xresolution" 32 "integer yresolution" 16
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
WorldBegin
LightSource "distant" "point from" [1 2 -3]
Material "matte"
Shape "sphere"
WorldEnd
"""
