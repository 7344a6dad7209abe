# Run by samples/run.sh in this folder.
character=/usr/share/assimp/models/BVH/01_01.bvh
"$make_garments" "$character" --kind skirt --flare 0.2 --out skirt.obj
"$make_garments" "$character" --kind top --out top.obj
