#!/bin/sh
# What the tests of the Python package install, by Python version: prints nothing for one that is not 3.9 to 3.13.
case $1 in
3.9) echo "numpy==2.0.2 gymnasium==1.1.1 pettingzoo==1.26.1 onnxruntime==1.19.2 mcap==1.6.0 jsonschema==4.23.0" ;;
3.1[0-3]) echo "numpy==2.2.6 gymnasium==1.2.0 pettingzoo==1.26.1 onnxruntime==1.22.1 mcap==1.6.0 jsonschema==4.23.0" ;;
esac
