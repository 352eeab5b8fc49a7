"""What parts of pictures are tested on: a lamp with soft shadows, glass, two things of one name. The head is each test's own."""

LOOK = """LookAt 0 2 -6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [45]
"""
WORLD = """WorldBegin
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [20 18 15] "string lightgroup" "lamp"
  Translate 1 4 -2
  Rotate 90 1 0 0
  Shape "disk" "float radius" [0.7]
AttributeEnd
Material "matte" "rgb Kd" [0.5 0.6 0.7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-5 0 -5 5 0 -5 5 0 5 -5 0 5]
Translate 0 1 0
Material "glass"
Shape "sphere"
Translate 2 0 1
Material "plastic"
Shape "sphere"
WorldEnd
"""
GAUSSIAN = 'PixelFilter "gaussian" "float xwidth" [2] "float ywidth" [2]'
LAYERS = ["--aov", "albedo,N,Z,shape,material,variance,samples,lightgroups"]
