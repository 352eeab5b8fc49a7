// A tree-sitter grammar of pbrt-v3 scene files. Made by tools/make-editors; do not edit.
// `tree-sitter generate` makes the parser of it.

// From NAMEBegin to NAMEEnd.
function block(name, $) {
  return seq(field('begin', alias(name + 'Begin', $.block_keyword)), optional(field('name', $.string)),
             repeat($._item), field('end', alias(name + 'End', $.block_keyword)));
}

module.exports = grammar({
  name: 'pbrt',
  word: $ => $.word,
  extras: $ => [/\s/, $.comment],

  rules: {
    source_file: $ => repeat($._item),
    _item: $ => choice($.block, $.statement),
    block: $ => choice(block('Attribute', $), block('Object', $), block('Transform', $), block('World', $)),
    // What stands behind a directive is for `whit lsp` to check.
    statement: $ => prec.right(seq(field('directive', $._directive), repeat(choice($._value, $.list, $.keyword)),
                                   repeat($.parameter))),
    _directive: $ => choice(alias($._with_plugin, $.plugin_directive), alias($._transform, $.transform_directive),
                            alias($._named, $.name_directive)),
    _with_plugin: $ => choice('Accelerator', 'AreaLightSource', 'Camera', 'Film', 'Filter', 'Integrator', 'LightSource', 'MakeNamedMaterial', 'MakeNamedMedium', 'Material', 'PixelFilter', 'Sampler', 'Shape', 'Texture'),
    _transform: $ => choice('ActiveTransform', 'ConcatTransform', 'Identity', 'LookAt', 'ReverseOrientation', 'Rotate', 'Scale', 'Transform', 'TransformTimes', 'Translate'),
    _named: $ => choice('CoordSysTransform', 'CoordinateSystem', 'Include', 'MediumInterface', 'NamedMaterial', 'ObjectInstance'),
    keyword: $ => choice('All', 'EndTime', 'StartTime'),
    parameter: $ => prec.right(seq(field('declaration', $.declaration), field('value', choice($._value, $.list)))),
    // Stronger than a string, which it looks like.
    declaration: $ => token(prec(1, /"[ \t]*(blackbody|spectrum|integer|normal3|texture|vector2|vector3|normal|point2|point3|string|vector|color|float|point|bool|rgb|xyz)[ \t]+[^" \t\n]+[ \t]*"/)),
    list: $ => seq('[', repeat($._value), ']'),
    _value: $ => choice($.string, $.number, $.boolean),
    string: $ => token(seq('"', repeat(choice(/[^"\\\n]/, /\\./)), '"')),
    boolean: $ => choice('true', 'false', token(prec(1, '"true"')), token(prec(1, '"false"'))),
    number: $ => token(/[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?/),
    word: $ => /[A-Za-z_]+/,
    comment: $ => token(/#.*/),
  },
});
