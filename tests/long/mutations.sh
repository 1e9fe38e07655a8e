#!/bin/sh
# Five thousand damaged files of each kind and layout: each is refused, or gives the same picture to the bit. They are the
# same in every run; test_mutations with another seed gives others.
exec nice "${BUILD:-build}/tests/unit/test_mutations" 5000 2
