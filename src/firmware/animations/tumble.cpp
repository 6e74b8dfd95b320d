// Moves: cones,polygons
// The first cone tumbles about its middle, and the first polygon turns about its own.
bool animate(uint32_t frame, uint32_t frames)
{
    using scene::Number;
    const uint32_t angle = qray::part_of_turn(frame, frames);
    const auto& cone = scene::first_cones[0];
    const auto& polygon = scene::first_polygons[0];
    const auto one = qray::coordinate<Number>(1);
    qray::Motion<Number> tumble(scene::frame), turn(scene::frame);
    tumble.about(scene::frame.place(cone.middle)).turn({one, one, {}}, angle);
    turn.about(scene::frame.place(polygon.middle)).turn({{}, one, {}}, angle);
    const qray::Corners<Number> first{scene::first_vertices.data, nullptr};
    const qray::MovedCorners<Number> corners{scene::vertices.data, nullptr};
    const bool moved = move(cone, tumble, scene::cones[0])
        && move(polygon, first, turn, scene::polygons[0], corners);
    scene::refit();
    return moved;
}
