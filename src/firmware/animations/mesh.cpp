// Moves: patches
// All patches turn together about an upright axis through the middle of the first one's ball, and the tree follows.
bool animate(uint32_t frame, uint32_t frames)
{
    using scene::Number;
    qray::Motion<Number> motion(scene::frame);
    motion.about(scene::frame.place(scene::first_patches[0].middle));
    motion.turn({{}, qray::coordinate<Number>(1), {}}, qray::part_of_turn(frame, frames));
    const qray::Corners<Number> first{scene::first_vertices.data, scene::first_normals.data};
    const qray::MovedCorners<Number> corners{scene::vertices.data, scene::normals.data};
    for (uint32_t i = 0; i < scene::patches.count; i++)
        if (!move(scene::first_patches[i], first, motion, scene::patches[i], corners))
            return false;
    scene::refit();
    return true;
}
