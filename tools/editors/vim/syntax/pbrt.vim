" Vim syntax of pbrt-v3 scene files. Made by tools/make-editors; do not edit.

if exists("b:current_syntax")
  finish
endif
syn case match

" A word with the shape of a statement that is none; the keywords below come before it.
syn match pbrtUnknown "\<\u\a\+\>"
syn match pbrtBlock "\<\%(AttributeBegin\|AttributeEnd\|ObjectBegin\|ObjectEnd\|TransformBegin\|TransformEnd\|WorldBegin\|WorldEnd\)\>"
syn region pbrtFold matchgroup=pbrtBlock start="\<WorldBegin\>" end="\<WorldEnd\>" transparent fold
syn region pbrtFold matchgroup=pbrtBlock start="\<AttributeBegin\>" end="\<AttributeEnd\>" transparent fold
syn region pbrtFold matchgroup=pbrtBlock start="\<TransformBegin\>" end="\<TransformEnd\>" transparent fold
syn region pbrtFold matchgroup=pbrtBlock start="\<ObjectBegin\>" end="\<ObjectEnd\>" transparent fold
syn keyword pbrtStatement Accelerator
syn keyword pbrtStatement AreaLightSource
syn keyword pbrtStatement Camera
syn keyword pbrtStatement Film
syn keyword pbrtStatement Filter
syn keyword pbrtStatement Integrator
syn keyword pbrtStatement LightSource
syn keyword pbrtStatement MakeNamedMaterial
syn keyword pbrtStatement MakeNamedMedium
syn keyword pbrtStatement Material
syn keyword pbrtStatement PixelFilter
syn keyword pbrtStatement Sampler
syn keyword pbrtStatement Shape
syn keyword pbrtStatement Texture
syn keyword pbrtTransform ActiveTransform
syn keyword pbrtTransform ConcatTransform
syn keyword pbrtTransform Identity
syn keyword pbrtTransform LookAt
syn keyword pbrtTransform ReverseOrientation
syn keyword pbrtTransform Rotate
syn keyword pbrtTransform Scale
syn keyword pbrtTransform Transform
syn keyword pbrtTransform TransformTimes
syn keyword pbrtTransform Translate
syn keyword pbrtNamed CoordSysTransform
syn keyword pbrtNamed CoordinateSystem
syn keyword pbrtNamed Include
syn keyword pbrtNamed MediumInterface
syn keyword pbrtNamed NamedMaterial
syn keyword pbrtNamed ObjectInstance
syn keyword pbrtWord All
syn keyword pbrtWord EndTime
syn keyword pbrtWord StartTime

syn match pbrtNumber "[-+]\=\<\d\+\%(\.\d*\)\=\%([eE][-+]\=\d\+\)\="
syn match pbrtNumber "[-+]\=\.\d\+\%([eE][-+]\=\d\+\)\="
syn match pbrtEscape "\\." contained
syn region pbrtString start=+"+ skip=+\\.+ end=+"+ end=+$+ contains=pbrtEscape
syn match pbrtBoolean "\"\%(true\|false\)\"\|\<\%(true\|false\)\>"
syn match pbrtType "\"\s*\%(blackbody\|spectrum\|integer\|normal3\|texture\|vector2\|vector3\|normal\|point2\|point3\|string\|vector\|color\|float\|point\|bool\|rgb\|xyz\)\>"ms=s+1 contained
syn match pbrtParameter "\"\s*\%(blackbody\|spectrum\|integer\|normal3\|texture\|vector2\|vector3\|normal\|point2\|point3\|string\|vector\|color\|float\|point\|bool\|rgb\|xyz\)\s\+[^\" \t]\+\s*\"" contains=pbrtType
syn match pbrtPlugin "\%(\<Camera\s\+\)\@<=\"\%(environment\|orthographic\|perspective\|realistic\)\""
syn match pbrtPlugin "\%(\<Film\s\+\)\@<=\"\%(image\)\""
syn match pbrtPlugin "\%(\<Filter\s\+\)\@<=\"\%(box\|gaussian\|mitchell\|sinc\|triangle\)\""
syn match pbrtPlugin "\%(\<PixelFilter\s\+\)\@<=\"\%(box\|gaussian\|mitchell\|sinc\|triangle\)\""
syn match pbrtPlugin "\%(\<Integrator\s\+\)\@<=\"\%(ambientocclusion\|directlighting\|path\|whitted\)\""
syn match pbrtPlugin "\%(\<Sampler\s\+\)\@<=\"\%(02sequence\|halton\|lowdiscrepancy\|maxmindist\|random\|sobol\|stratified\)\""
syn match pbrtPlugin "\%(\<Material\s\+\)\@<=\"\%(disney\|fourier\|glass\|hair\|kdsubsurface\|matte\|metal\|metallicroughness\|mirror\|mix\|none\|perfectglass\|plastic\|substrate\|subsurface\|translucent\|uber\)\""
syn match pbrtPlugin "\%(\<LightSource\s\+\)\@<=\"\%(distant\|exinfinite\|goniometric\|infinite\|point\|projection\|skybox\|spot\)\""
syn match pbrtPlugin "\%(\<AreaLightSource\s\+\)\@<=\"\%(area\|diffuse\)\""
syn match pbrtPlugin "\%(\<Shape\s\+\)\@<=\"\%(cone\|curve\|cylinder\|disk\|gltf\|heightfield\|hyperboloid\|loopsubdiv\|nurbs\|paraboloid\|plymesh\|sphere\|trianglemesh\)\""
syn match pbrtPlugin "\%(\<Texture\s\+\"[^\"]*\"\s\+\"\%(float\|spectrum\|color\)\"\s\+\)\@<=\"\%(angle\|bilerp\|checkerboard\|constant\|dots\|fbm\|imagemap\|marble\|mix\|scale\|threshold\|uv\|vertexcolor\|windy\|wrinkled\)\""
syn match pbrtComment "#.*$" contains=@Spell,pbrtTodo
syn keyword pbrtTodo TODO FIXME contained

" Long lists of numbers lie between two places at which Vim looks for the start of a string.
syn sync minlines=100

hi def link pbrtBlock Statement
hi def link pbrtStatement Keyword
hi def link pbrtTransform Function
hi def link pbrtNamed Keyword
hi def link pbrtWord Constant
hi def link pbrtNumber Number
hi def link pbrtString String
hi def link pbrtEscape SpecialChar
hi def link pbrtBoolean Boolean
hi def link pbrtType Type
hi def link pbrtParameter Identifier
hi def link pbrtPlugin Structure
hi def link pbrtComment Comment
hi def link pbrtTodo Todo
hi def link pbrtUnknown Error

let b:current_syntax = "pbrt"
