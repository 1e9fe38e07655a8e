# The add-on for Blender, without Blender: it is Python that compiles, and nothing in it is undefined or unused.
$ /usr/bin/python3 -c "import sys; compile(open(sys.argv[1]).read(), sys.argv[1], 'exec')" $TESTS/../../tools/blender/retex_export.py
$ if command -v pyflakes3 >/dev/null; then pyflakes3 $TESTS/../../tools/blender/retex_export.py; fi
# The sockets of Principled shaders by the names of Blender 3.4, and by those of 4.
$ /usr/bin/python3 $TESTS/blender_stub.py $TESTS/../../tools/blender/retex_export.py
> Blender 3
>   BSDF_DIFFUSE {'Base Color': 'BSDF_DIFFUSE.Color', 'Specular': 0.0, 'Roughness': 0.5, 'IOR': 1.5}
>   BSDF_GLOSSY {'Base Color': 'BSDF_GLOSSY.Color', 'Metallic': 1.0, 'Roughness': 'BSDF_GLOSSY.Roughness', 'IOR': 1.5}
>   BSDF_GLASS {'Base Color': 'BSDF_GLASS.Color', 'Roughness': 'BSDF_GLASS.Roughness', 'IOR': 'BSDF_GLASS.IOR', 'Transmission': 1.0}
>   EMISSION {'Base Color': (0, 0, 0, 1), 'Specular': 0.0, 'IOR': 1.5, 'Emission': 'EMISSION.Color', 'Emission Strength': 'EMISSION.Strength'}
>   ['b', 'd'] Material_2nd_floor_001
> Blender 4
>   BSDF_DIFFUSE {'Base Color': 'BSDF_DIFFUSE.Color', 'Roughness': 0.5, 'Specular IOR Level': 0.0}
>   BSDF_GLOSSY {'Base Color': 'BSDF_GLOSSY.Color', 'Metallic': 1.0, 'Roughness': 'BSDF_GLOSSY.Roughness'}
>   BSDF_GLASS {'Base Color': 'BSDF_GLASS.Color', 'Roughness': 'BSDF_GLASS.Roughness', 'IOR': 'BSDF_GLASS.IOR', 'Transmission Weight': 1.0}
>   EMISSION {'Base Color': (0, 0, 0, 1), 'Specular IOR Level': 0.0, 'Emission Color': 'EMISSION.Color', 'Emission Strength': 'EMISSION.Strength'}
>   ['b', 'd'] Material_2nd_floor_001
