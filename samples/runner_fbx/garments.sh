# Run by samples/run.sh in this folder.
"$make_garments" ../../../shared/assets/characters/ozz_pab_fbx/skeleton.fbx --kind skirt --out skirt.obj
