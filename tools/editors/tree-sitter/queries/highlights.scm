; Made by tools/make-editors; do not edit.
(comment) @comment
(block_keyword) @keyword
(plugin_directive) @type
(transform_directive) @function
(name_directive) @keyword
(keyword) @constant
(declaration) @property
(string) @string
(boolean) @boolean
(number) @number
["[" "]"] @punctuation.bracket
((statement directive: (plugin_directive) . (string) @type.builtin))
