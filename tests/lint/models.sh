#!/bin/sh
# The models of 5 against 5 are what models/make_5v5.py makes of those of 3 against 3.
python3 models/make_5v5.py --check
