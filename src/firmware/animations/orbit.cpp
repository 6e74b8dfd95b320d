// Moves: camera
// The camera goes once round the place that it looks at.
bool animate(uint32_t frame, uint32_t frames)
{
    auto view = scene::view;
    qray::Motion<scene::Number> motion(scene::frame);
    motion.about(view.at).turn(view.up, qray::part_of_turn(frame, frames));
    view.eye = scene::frame.place(motion(scene::frame.point(view.eye)));
    return qray::look_at(scene::camera, scene::frame, view);
}
