; Made by tools/make-editors; do not edit.
(block) @fold
(list) @fold
